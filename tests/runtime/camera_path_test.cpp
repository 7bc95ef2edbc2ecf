// Camera paths: interpolation between keys, and messages about invalid files.
#include "format/vec3d.h"
#include "runtime/camera_path.h"
#include "runtime/path_recorder.h"
#include "tests/tools/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace
{
// Floats hold a unit vector and positions of a few metres to 6e-8 and 5e-7; what is computed in between is in doubles.
constexpr double kRounding = 2e-6;

Vec3d turned(const Vec3d& v, const Vec3d& axis, double angle) // Rodrigues' formula
{
    return v * std::cos(angle) + cross(axis, v) * std::sin(angle) + axis * (dot(axis, v) * (1 - std::cos(angle)));
}

double distance(gpu::vec3 a, const Vec3d& b)
{
    return length(toDouble(a) - b);
}

CameraKey key(double time, const Vec3d& position, const Vec3d& forward = {0, 0, -1}, const Vec3d& up = {0, 1, 0})
{
    return {time, {.position = toFloat(position), .forward = toFloat(forward), .up = toFloat(up)}};
}

bool same(const Camera& a, const Camera& b)
{
    const auto equal = [](gpu::vec3 p, gpu::vec3 q) { return p.x == q.x && p.y == q.y && p.z == q.z; };
    return equal(a.position, b.position) && equal(a.forward, b.forward) && equal(a.up, b.up) &&
           a.vertical_fov == b.vertical_fov && a.orthographic_height == b.orthographic_height &&
           a.near_plane == b.near_plane && a.far_plane == b.far_plane;
}

/// Keys anywhere, looking anywhere, at uneven times.
CameraPath randomPath(uint32_t seed)
{
    std::mt19937 random(seed);
    const auto number = [&](double least, double most) { return std::uniform_real_distribution(least, most)(random); };
    const auto direction = [&] { return unitOrZero(Vec3d{number(-1, 1), number(-1, 1), number(-1, 1)}); };
    std::vector<CameraKey> keys;
    for (double time = -1; keys.size() < 8; time += number(0.05, 2))
    {
        const Vec3d forward = direction();
        keys.push_back(key(time, {number(-3, 3), number(-3, 3), number(-3, 3)}, forward,
                           unitOrZero(cross(cross(forward, direction()), forward))));
        keys.back().camera.vertical_fov = float(number(0.1, 2));
    }
    return CameraPath(keys);
}

TEST(CameraPath, MeetsItsKeys)
{
    const CameraPath path = randomPath(1);
    for (const CameraKey& key : path.keys())
    {
        const Camera there = path.at(key.time);
        EXPECT_LT(distance(there.position, toDouble(key.camera.position)), kRounding);
        EXPECT_LT(distance(there.forward, toDouble(key.camera.forward)), kRounding);
        EXPECT_LT(distance(there.up, toDouble(key.camera.up)), kRounding);
        EXPECT_FLOAT_EQ(there.vertical_fov, key.camera.vertical_fov);
    }
}

TEST(CameraPath, EvenMotionStaysEven)
{
    const Vec3d velocity{1.1, 0.2, -0.7}, axis = unitOrZero(Vec3d{0.3, 1, 0.2}),
                                          forward = unitOrZero(Vec3d{1, -0.3, 0.1});
    const Vec3d up = unitOrZero(cross(cross(forward, Vec3d{0, 1, 0}), forward));
    constexpr double kTurn = 70 * std::numbers::pi / 180; // radians a second: more than a whole turn in all
    const auto position = [&](double t) { return Vec3d{2, 1, 0} + velocity * t; };
    std::vector<CameraKey> keys;
    for (const double time : {0.0, 0.1, 2.0, 2.5, 4.4, 5.0, 7.0}) // 140 degrees from key to key at most
        keys.push_back(key(time, position(time), turned(forward, axis, kTurn * time), turned(up, axis, kTurn * time)));
    const CameraPath path(keys);
    for (double time = 0; time <= 7; time += 0.07)
    {
        SCOPED_TRACE(time);
        const Camera camera = path.at(time);
        EXPECT_LT(distance(camera.position, position(time)), 4 * kRounding);
        EXPECT_LT(distance(camera.forward, turned(forward, axis, kTurn * time)), 4 * kRounding);
        EXPECT_LT(distance(camera.up, turned(up, axis, kTurn * time)), 4 * kRounding);
    }
}

TEST(CameraPath, EvenAccelerationIsMetBetweenEvenKeys)
{
    const auto position = [](double t) { return Vec3d{0.5 * t * t, 1 - t, 0.1 * t * t}; };
    std::vector<CameraKey> keys;
    for (const double time : {0.0, 0.5, 1.0, 1.5, 2.0})
        keys.push_back(key(time, position(time)));
    const CameraPath path(keys);
    for (double time = 0.5; time <= 1.5; time += 0.05)
        EXPECT_LT(distance(path.at(time).position, position(time)), kRounding) << time;
}

TEST(CameraPath, AFastMoveIsNotCarriedOnIntoASlowOne)
{
    const CameraPath path({key(0, {}), key(0.5, {5, 0, 0}), key(10, {6, 0, 0}), key(10.001, {9, 0, 0})});
    for (double time = 0; time <= 10; time += 0.01)
    {
        const double x = path.at(time).position.x;
        EXPECT_GE(x, 0) << time;
        EXPECT_LE(x, 5 + (5 + 1) / 3.0)
            << time; // a curve's control points lie a third of the two ways around a key from it
    }
}

TEST(CameraPath, SpeedsDoNotJumpAtKeys)
{
    constexpr double kStep = 1e-3;
    for (uint32_t seed = 0; seed < 10; ++seed)
    {
        const CameraPath path = randomPath(seed);
        for (size_t i = 1; i + 1 < path.keys().size(); ++i)
        {
            SCOPED_TRACE(fmt::format("seed {}, key {}", seed, i));
            const double time = path.keys()[i].time;
            // One-sided slopes of parabolas are off by a third of the step's square times the third derivative, which
            // is 12 |change| / 0.05^3 at most: by less than a hundredth of the fastest slope, |change| / 0.05.
            const auto slopes = [&](double h, gpu::vec3 Camera::*member)
            {
                const auto at = [&](double t) { return toDouble(path.at(t).*member); };
                return (at(time + h) * 4 - at(time) * 3 - at(time + 2 * h)) * (1 / (2 * h));
            };
            for (gpu::vec3 Camera::*member : {&Camera::position, &Camera::forward, &Camera::up})
            {
                const Vec3d before = slopes(-kStep, member), after = slopes(kStep, member);
                EXPECT_LT(length(before - after), 0.02 * (length(before) + length(after)) + 0.05);
            }
        }
    }
}

TEST(CameraPath, FramesAreOrthonormalAndFieldsOfViewBetweenThoseOfTheirKeys)
{
    const CameraPath path = randomPath(3);
    for (double time = path.start(); time < path.end(); time += 0.01)
    {
        const Camera camera = path.at(time);
        EXPECT_NEAR(length(toDouble(camera.forward)), 1, kRounding);
        EXPECT_NEAR(length(toDouble(camera.up)), 1, kRounding);
        EXPECT_NEAR(dot(toDouble(camera.forward), toDouble(camera.up)), 0, kRounding);
        size_t i = 0;
        while (path.keys()[i + 1].time <= time)
            ++i;
        const float a = path.keys()[i].camera.vertical_fov, b = path.keys()[i + 1].camera.vertical_fov;
        EXPECT_GE(camera.vertical_fov, std::min(a, b));
        EXPECT_LE(camera.vertical_fov, std::max(a, b));
    }
}

TEST(CameraPath, HoldsBeforeTheFirstKeyAndAfterTheLast)
{
    const CameraPath path = randomPath(4);
    for (const double before : {path.start() - 1e9, path.start() - 0.1, path.start()})
        EXPECT_TRUE(same(path.at(before), path.keys().front().camera)) << before;
    for (const double after : {path.end(), path.end() + 0.1, path.end() + 1e9})
        EXPECT_TRUE(same(path.at(after), path.keys().back().camera)) << after;
    const CameraPath still({path.keys()[2]});
    EXPECT_TRUE(same(still.at(-5), path.keys()[2].camera));
    EXPECT_TRUE(same(still.at(5), path.keys()[2].camera));
}

TEST(CameraPath, RestsBetweenEqualKeys)
{
    const CameraPath moving = randomPath(5);
    std::vector<CameraKey> keys = {moving.keys()[0], moving.keys()[1], moving.keys()[1], moving.keys()[2]};
    for (size_t i = 0; i < keys.size(); ++i)
        keys[i].time = double(i);
    const CameraPath path(keys);
    const Camera rest = path.at(1);
    for (double time = 1; time < 2; time += 0.1)
        EXPECT_TRUE(same(path.at(time), rest)) << time;
    EXPECT_LT(distance(path.at(2).position, toDouble(rest.position)), kRounding);
}

TEST(CameraPath, ProjectionsOfTwoKindsAreNotMixed)
{
    std::vector<CameraKey> keys = {key(0, {}), key(1, {1, 0, 0}), key(2, {2, 0, 0})};
    keys[1].camera.vertical_fov = 0;
    keys[1].camera.orthographic_height = 3;
    keys[0].camera.far_plane = 10;
    const CameraPath path(keys);
    EXPECT_EQ(path.at(0.9).vertical_fov, keys[0].camera.vertical_fov);
    EXPECT_EQ(path.at(0.9).orthographic_height, 0);
    EXPECT_EQ(path.at(0.9).far_plane, 0); // the other key has none
    EXPECT_EQ(path.at(1.9).orthographic_height, 3);
    EXPECT_EQ(path.at(1.9).vertical_fov, 0);
}

TEST(CameraPath, ReadsWhatItSaves)
{
    CameraPath path = randomPath(6);
    std::vector<CameraKey> keys = path.keys();
    keys[3].camera.vertical_fov = 0;
    keys[3].camera.orthographic_height = 2.5f;
    keys[4].camera.near_plane = 0.1f;
    keys[4].camera.far_plane = 30;
    path = CameraPath(keys);
    const TemporaryFolder folder;
    ASSERT_TRUE(path.save(folder / "path.json"));
    const auto read = CameraPath::load(folder / "path.json", {});
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->keys().size(), keys.size());
    for (size_t i = 0; i < keys.size(); ++i)
    {
        const Camera &a = keys[i].camera, &b = read->keys()[i].camera;
        EXPECT_EQ(read->keys()[i].time, keys[i].time);
        EXPECT_LT(distance(b.position, toDouble(a.position)), 1e-12);
        EXPECT_LT(distance(b.forward, toDouble(a.forward)), kRounding);
        EXPECT_LT(distance(b.up, toDouble(a.up)), kRounding);
        EXPECT_EQ(b.vertical_fov, a.vertical_fov);
        EXPECT_EQ(b.orthographic_height, a.orthographic_height);
        EXPECT_EQ(b.near_plane, a.near_plane);
        EXPECT_EQ(b.far_plane, a.far_plane);
    }
    const Status status = path.save(folder / "none/path.json");
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ExitCode::kIo);
}

TEST(PathRecorder, FollowsTheHandAndEndsWhereItIs)
{
    const CameraPath hand = randomPath(7);
    constexpr double kFrame = 1.0 / 60;
    const auto flown = [&](int frame) { return hand.at(hand.start() + frame * kFrame); };
    PathRecorder recorder(flown(0));
    for (int frame = 1; frame <= 100; ++frame)
        recorder.add(flown(frame), kFrame);
    const CameraPath path = recorder.finish(flown(100));
    EXPECT_EQ(path.start(), 0);
    EXPECT_NEAR(path.end(), 100 * kFrame, 1e-9);
    EXPECT_TRUE(same(path.at(path.end()), flown(100)));
    for (size_t i = 1; i < path.keys().size(); ++i)
    {
        EXPECT_LT(path.keys()[i].time - path.keys()[i - 1].time, 0.25);
        const Camera camera = hand.at(hand.start() + path.keys()[i].time);
        EXPECT_LT(distance(path.keys()[i].camera.position, toDouble(camera.position)), 1e-4);
    }
    PathRecorder short_one(flown(0));
    EXPECT_EQ(short_one.finish(flown(0)).keys().size(), 1u);
}

const std::vector<Camera> kCameras = {{.name = "hall", .position = {1, 2, 3}}, {.name = "0", .position = {4, 5, 6}}};

TEST(CameraPath, CamerasOfThePackageAreNamed)
{
    const auto path = CameraPath::parse(R"({"schema": "lumicut-path/1", "keys": [{"time": 0, "camera": "hall"},
        {"time": 1, "camera": "0"}, {"time": 2, "camera": 0}, {"time": 3, "camera": "1"}]})",
                                        kCameras);
    ASSERT_TRUE(path) << path.error().message;
    for (size_t i = 0; i < 4; ++i)
        EXPECT_EQ(path->keys()[i].camera.name, i % 2 == 0 ? "hall" : "0") << i;
}

TEST(CameraPath, TheExampleOfTheDocumentIsAPath)
{
    const std::string document = fileBytes(LUMICUT_PATH_DOCUMENT);
    const size_t begin = document.find("```json\n") + 8, end = document.find("```", begin);
    ASSERT_NE(end, std::string::npos);
    const auto path = CameraPath::parse(document.substr(begin, end - begin), kCameras);
    ASSERT_TRUE(path) << path.error().message;
    EXPECT_GE(path->keys().size(), 3u);
}

TEST(CameraPath, SaysWhatIsWrongAndWhere)
{
    const auto refused = [](const std::string& text, const std::string& words)
    {
        SCOPED_TRACE(text);
        const auto path = CameraPath::parse(text, kCameras);
        ASSERT_FALSE(path);
        EXPECT_EQ(path.error().code, ExitCode::kInvalid);
        EXPECT_NE(path.error().message.find(words), std::string::npos) << path.error().message;
    };
    refused("", "its JSON cannot be read");
    refused("{\"keys\": [", "its JSON cannot be read");
    refused(R"({"schema": "lumicut-path/1", "keys": [{"time": 1e999, "camera": 0}]})", "its JSON cannot be read");
    refused("[]", "an object is expected (/)");
    refused(R"({"keys": []})", "(/schema)");
    refused(R"({"schema": "lumicut-path/2", "keys": []})", "(/schema)");
    refused(R"({"schema": "lumicut-path/1"})", "(/keys)");
    refused(R"({"schema": "lumicut-path/1", "keys": []})", "(/keys)");
    refused(R"({"schema": "lumicut-path/1", "keys": [3]})", "(/keys/0)");
    const auto key = [&](const std::string& text, const std::string& words)
    {
        refused(fmt::format(R"({{"schema": "lumicut-path/1", "keys": [{{"time": 0, "camera": 0}}, {{{}}}]}})", text),
                words);
    };
    const std::string there = R"("time": 1, "position": [0, 0, 0], "forward": [0, 0, -2])";
    key(R"("camera": 0)", "no time (/keys/1/time)");
    key(R"("time": "1", "camera": 0)", "(/keys/1/time)");
    key(R"("time": 0, "camera": 0)", "(/keys/1/time)");
    key(R"("time": -1, "camera": 0)", "(/keys/1/time)");
    key(R"("time": 1, "camera": "cellar")", "'cellar'; the package has hall (0), 0 (1) (/keys/1/camera)");
    key(R"("time": 1, "camera": 2)", "'2'; the package has");
    key(R"("time": 1, "camera": -1)", "(/keys/1/camera)");
    key(R"("time": 1, "camera": 0, "vertical_fov": 1)", "nothing else but its time (/keys/1)");
    key(R"("time": 1)", "neither a camera nor a position (/keys/1/position)");
    key(R"("time": 1, "position": [0, 0], "forward": [0, 0, -1])", "(/keys/1/position)");
    key(R"("time": 1, "position": [0, 0, 1e30], "forward": [0, 0, -1])", "(/keys/1/position)");
    key(R"("time": 1, "position": [0, 0, 0])", "(/keys/1/forward)");
    key(R"("time": 1, "position": [0, 0, 0], "forward": [0, 0, 0])", "must not be zero (/keys/1/forward)");
    key(R"("time": 1, "position": [0, 0, 0], "forward": [0, -1, 0])", "(/keys/1/up)");
    key(there + R"(, "up": [0, 0, 1])", "(/keys/1/up)");
    key(there + R"(, "vertical_fov": 0)", "(/keys/1/vertical_fov)");
    key(there + R"(, "vertical_fov": 3.2)", "(/keys/1/vertical_fov)");
    key(there + R"(, "vertical_fov": 1, "orthographic_height": 1)", "(/keys/1/orthographic_height)");
    key(there + R"(, "near_plane": 2, "far_plane": 1)", "(/keys/1/far_plane)");
    key(there + R"(, "vertical_fow": 1)", "'vertical_fow' is unknown here");
}

TEST(CameraPath, NamesAFileThatCannotBeRead)
{
    const TemporaryFolder folder;
    const auto none = CameraPath::load(folder / "none.json", kCameras);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ExitCode::kIo);
    EXPECT_EQ(none.error().file, (folder / "none.json").string());
    std::ofstream(folder / "empty.json");
    const auto empty = CameraPath::load(folder / "empty.json", kCameras);
    ASSERT_FALSE(empty);
    EXPECT_EQ(empty.error().code, ExitCode::kInvalid);
    EXPECT_EQ(empty.error().file, (folder / "empty.json").string());
}
} // namespace
