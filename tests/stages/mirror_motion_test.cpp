// Motion vectors of what moves and is seen in a plane mirror: its image moves as the mirror shows it.
#include "compiler/compile.h"
#include "runtime/stages/pose.h"
#include "runtime/stages/primary.h"
#include "runtime/stages/signals.h"
#include "tests/compiler/gltf_builder.h"
#include "tests/stages/gi_test.h"

#include <cmath>

namespace
{
using nlohmann::json;

constexpr uint32_t kWidth = 42, kHeight = 26, kPixels = kWidth * kHeight;
constexpr int kFloat = 5126, kUnsignedShort = 5123;
const Vec3d kNormal{0.28, 0, 0.96}; // of the mirror, in the plane through the origin

Vec3d reflected(const Vec3d& p)
{
    return p - kNormal * (2 * dot(p, kNormal));
}

class MirrorMotion : public GiTest
{
protected:
    /// A mirror behind a card that travels by `way` within a second.
    void compileScene(const Vec3d& way)
    {
        GltfBuilder gltf;
        const auto quad = [&](const std::vector<float>& corners, int material)
        {
            return gltf.mesh({{"attributes", {{"POSITION", gltf.positions(corners)}}},
                              {"indices", gltf.accessor<uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR", kUnsignedShort, 6)},
                              {"material", material}});
        };
        const int mirror = gltf.material({{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}}});
        const int white = gltf.material(lambert(0.8));
        const float x = float(kNormal.z) * 4, z = float(kNormal.x) * 4;
        gltf.node({{"mesh", quad({-x, -3, z, x, -3, -z, x, 3, -z, -x, 3, z}, mirror)}});
        gltf.node(
            {{"mesh", quad({-0.8f, -0.7f, 1.8f, 0.8f, -0.7f, 1.4f, 0.8f, 0.7f, 1.4f, -0.8f, 0.7f, 1.8f}, white)}});
        const int times = gltf.accessor<float>({0, 1}, "SCALAR", kFloat, 2);
        gltf.json["accessors"][size_t(times)]["min"] = {0};
        gltf.json["accessors"][size_t(times)]["max"] = {1};
        const int places = gltf.accessor<float>({0, 0, 0, float(way.x), float(way.y), float(way.z)}, "VEC3", kFloat, 2);
        gltf.json["animations"] = json::array(
            {{{"samplers", json::array({{{"input", times}, {"output", places}}})},
              {"channels", json::array({{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}})}}});
        gltf.json["scenes"][0]["nodes"] = {0, 1};
        gltf.writeGltf(folder_ / "mirror.gltf");
        const auto report = compile({.input = folder_ / "mirror.gltf", .output = folder_ / "mirror.lumi"});
        ASSERT_TRUE(report) << report.error().message;
    }

    TemporaryFolder folder_;
};

TEST_F(MirrorMotion, IsThatOfTheImage)
{
    const Vec3d way{1.5, 0.7, 2.5};
    compileScene(way);
    const auto package = package::Package::open(folder_ / "mirror.lumi");
    ASSERT_TRUE(package);
    const auto scene = load(folder_ / "mirror.lumi");
    const Camera camera{
        .name = "", .position = {0, 0, 6}, .forward = {0, 0, -1}, .up = {0, 1, 0}, .vertical_fov = 0.9f};
    PoseStage pose(device(), *scene, *package);
    SignalsStage signals(device(), *scene, kPixels);
    PrimaryStage primary(device(), *scene, kPixels);
    LightBuffers light(device(), kPixels, true);
    const RayStage rays(device(), *scene);
    FrameInfo frame{.camera = cameraParams(camera, kWidth, kHeight), .number = 0};
    frame.camera.jitter = {0.5f, 0.5f};
    constexpr double kFrom = 0.4, kTo = 0.5;
    std::vector<gpu::ShadingPoint> points;
    std::vector<gpu::Motion> motions;
    const Buffer *of_points = nullptr, *of_motions = nullptr;
    for (const double seconds : {kFrom, kTo})
    {
        submit(*scene,
               [&](Recorder& rec)
               {
                   pose.record(rec, package::poseAt(*package, 0, seconds));
                   light.clear(rec, gpu::kLightIndirect | gpu::kLightCaustics);
                   const SurfaceBuffers surface = primary.record(
                       rec, rays, {.camera = frame.camera, .specular_depth = 2, .emission = light.emission});
                   const SignalBuffers made = signals.record(rec, frame, surface, light, gpu::kLightDirect);
                   of_points = &surface.points;
                   of_motions = &made.motions;
               });
        points = contents<gpu::ShadingPoint>(*of_points, kPixels);
        motions = contents<gpu::Motion>(*of_motions, kPixels);
        frame.previous = frame.camera;
        ++frame.number;
    }
    const double half = std::tan(0.45), aspect = double(kWidth) / kHeight;
    uint32_t direct = 0, mirrored = 0;
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
    {
        const gpu::ShadingPoint& point = points[pixel];
        if (point.slot == gpu::kNone || point.slot < package->firstMovingSlot())
            continue;
        ++(point.depth == 0 ? direct : mirrored);
        ASSERT_LE(point.depth, 1u);
        const Vec3d was = toDouble(point.position) - way * (kTo - kFrom);
        const Vec3d image = point.depth == 0 ? was : reflected(was);
        const double depth = 6 - image.z;
        EXPECT_NEAR(pixel % kWidth + motions[pixel].from.x, (image.x / (depth * half * aspect) + 1) / 2 * kWidth - 0.5,
                    2e-3);
        EXPECT_NEAR(pixel / kWidth + motions[pixel].from.y, (1 - image.y / (depth * half)) / 2 * kHeight - 0.5, 2e-3);
    }
    EXPECT_GT(direct, 20u);
    EXPECT_GE(mirrored, 20u);
}
} // namespace
