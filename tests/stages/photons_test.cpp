// Photons: no watt more or less than the lights give, where it falls, and aimed emission against unaimed.
#include "tests/stages/gi_test.h"
#include "tests/stages/ray_test.h"

#include <cstring>
#include <numbers>

namespace
{
constexpr double kPi = std::numbers::pi;
constexpr uint32_t kPaths = 8192;
constexpr uint32_t kUnaimedPaths = 131072; // few of them meet a mirror

/// Sum over the photons and the standard error that independent paths, one photon each, would have.
struct Power
{
    Double3 sum, standard_error;
};

template <typename Wanted>
Power powerOf(std::span<const gpu::Photon> photons, Wanted&& wanted, double path_count = kPaths)
{
    Double3 sum, squares;
    for (const gpu::Photon& photon : photons)
        if (wanted(photon))
        {
            const Double3 p = photon.power;
            sum = sum + p;
            squares = squares + Double3(p.x * p.x, p.y * p.y, p.z * p.z);
        }
    const auto error = [&](double square, double s) { return std::sqrt(std::max(0.0, square - s * s / path_count)); };
    return {.sum = sum, .standard_error = {error(squares.x, sum.x), error(squares.y, sum.y), error(squares.z, sum.z)}};
}

constexpr auto kAll = [](const gpu::Photon&) { return true; };

/// 4 standard errors: sobol points, being better than independent ones, stay within; 1e-5: rounding of 8192 summands.
void expectPower(const Power& got, Double3 want, double largest_error, const char* what)
{
    const std::tuple<double, double, double> channels[]{{got.sum.x, want.x, got.standard_error.x},
                                                        {got.sum.y, want.y, got.standard_error.y},
                                                        {got.sum.z, want.z, got.standard_error.z}};
    for (const auto& [sum, wanted, error] : channels)
    {
        fmt::print("  {}: got {:.6g} W want {:.6g} W ({:+.3f} %, standard error {:.3f} %)\n", what, sum, wanted,
                   100 * (sum / wanted - 1), 100 * error / wanted);
        EXPECT_LE(std::abs(sum - wanted), 4 * error + 1e-5 * wanted) << what;
        EXPECT_LE(error, largest_error * wanted) << what << ": too few photons to tell";
    }
}

/// Photons of the last bounce: those of the same paths with one bounce fewer are among them, in the same order.
std::vector<gpu::Photon> without(std::span<const gpu::Photon> photons, std::span<const gpu::Photon> earlier)
{
    std::vector<gpu::Photon> rest;
    size_t passed = 0;
    for (const gpu::Photon& photon : photons)
        if (passed < earlier.size() && length2(Double3(photon.position) - Double3(earlier[passed].position)) == 0)
            ++passed;
        else
            rest.push_back(photon);
    EXPECT_EQ(passed, earlier.size());
    return rest;
}

class Photons : public GiTest
{
protected:
    static PhotonStage::Input firstHits(uint32_t seed = 1)
    {
        return {.path_count = kPaths, .first_path = 0, .seed = seed, .bounce_limit = 1};
    }
};

// ---- What lights give ----------------------------------------------------------------------------------------------

/// A closed room of 4 x 3 x 4 metres.
void addRoom(SceneBuilder& builder, const nlohmann::json& walls)
{
    builder.box({-2, 0, -2}, {2, 3, 2}, builder.material(walls), true);
}

struct Lit
{
    const char* name;
    std::function<void(SceneBuilder&)> build;
    Double3 power;        // W that fall on the scene
    double largest_error; // that 8192 independent photons may have
};

void PrintTo(const Lit& value, std::ostream* out) // NOLINT: GoogleTest's name
{
    *out << value.name;
}

const nlohmann::json kAbove{{"translation", {0.3, 2, -0.4}}};
const nlohmann::json kDownwards{{"translation", {0.3, 2, -0.4}},
                                {"rotation", {-std::numbers::sqrt2 / 2, 0, 0, std::numbers::sqrt2 / 2}}};

nlohmann::json coloredLamp()
{
    return with(emitter(5), {{"emissiveFactor", {1, 0.5, 0.25}}});
}

ImageF sky(float r, float g, float b)
{
    ImageF map{16, 8, {}};
    for (size_t i = 0; i < map.pixelCount(); ++i)
        map.rgb.insert(map.rgb.end(), {r, g, b});
    return map;
}

std::vector<Lit> lights()
{
    constexpr double kInner = 0.3, kOuter = 0.8;
    const double full = 1 - std::cos(kInner), falloff = std::cos(kInner) - std::cos(kOuter);
    const double spot = 2 * kPi * (full + falloff / 3); // the falloff is a square from 0 to 1 over equal solid angles
    const double lamp = 0.8 * 0.5;
    const auto room = [](SceneBuilder& builder) { addRoom(builder, lambert(0.5)); };
    const auto block = [](SceneBuilder& builder) { builder.box({0, 0, 0}, {3, 2, 5}, builder.material(lambert(0.5))); };
    const auto quad = [](SceneBuilder& builder, const nlohmann::json& material) {
        builder.quad({-0.4f, 2.5f, -0.25f}, {0.8f, 0, 0}, {0, 0, 0.5f}, builder.material(material));
    };
    return {
        {"Point",
         [=](SceneBuilder& builder)
         {
             room(builder);
             builder.light({{"type", "point"}, {"intensity", 3}, {"color", {1, 0.5, 0.25}}}, kAbove);
         },
         4 * kPi * 3 * Double3(1, 0.5, 0.25), 1e-3},
        {"Spot",
         [=](SceneBuilder& builder)
         {
             room(builder);
             builder.light({{"type", "spot"},
                            {"intensity", 3},
                            {"spot", {{"innerConeAngle", kInner}, {"outerConeAngle", kOuter}}}},
                           kDownwards);
         },
         3 * spot * Double3(1, 1, 1), 0.02},
        {"Directional", // downwards along (0, -1, -1), onto a block's top and side
         [=](SceneBuilder& builder)
         {
             block(builder);
             builder.light({{"type", "directional"}, {"intensity", 2}},
                           {{"rotation", {-std::sin(kPi / 8), 0, 0, std::cos(kPi / 8)}}});
         },
         2 * (std::sqrt(0.5) * 3 * 5 + std::sqrt(0.5) * 3 * 2) * Double3(1, 1, 1), 0.02},
        {"Triangle",
         [=](SceneBuilder& builder)
         {
             room(builder);
             quad(builder, coloredLamp());
         },
         kPi * 5 * lamp * Double3(1, 0.5, 0.25), 1e-3},
        {"TwoSidedTriangle",
         [=](SceneBuilder& builder)
         {
             room(builder);
             quad(builder, with(coloredLamp(), {{"doubleSided", true}}));
         },
         2 * kPi * 5 * lamp * Double3(1, 0.5, 0.25), 1e-3},
        {"Environment", // on a convex body: radiance x pi x its surface (Cauchy's mean projected area)
         [=](SceneBuilder& builder)
         {
             block(builder);
             builder.environment(sky(1, 0.5f, 2));
         },
         kPi * 2 * (3 * 2 + 2 * 5 + 5 * 3) * Double3(1, 0.5, 2), 0.02},
        {"AllOfThem",
         [=](SceneBuilder& builder)
         {
             builder.box({0, 0, 0}, {3, 2, 5}, builder.material(lambert(0.5)));
             builder.box({10, 0, 0}, {13, 2, 5}, builder.material(lambert(0.5)), true); // dark outside, lit within
             builder.light({{"type", "point"}, {"intensity", 3}}, {{"translation", {11, 1, 1}}});
             builder.light({{"type", "spot"},
                            {"intensity", 8},
                            {"spot", {{"innerConeAngle", kInner}, {"outerConeAngle", kOuter}}}},
                           {{"translation", {12, 1, 2}}});
             builder.quad({11, 1.5f, 2}, {0.8f, 0, 0}, {0, 0, 0.5f}, builder.material(emitter(5)));
             builder.light({{"type", "directional"}, {"intensity", 2}},
                           {{"rotation", {-std::sin(kPi / 4), 0, 0, std::cos(kPi / 4)}}}); // straight down on both
         },
         (4 * kPi * 3 + 8 * spot + kPi * 5 * lamp + 2 * 2 * 3 * 5) * Double3(1, 1, 1), 0.03},
    };
}

class Lights : public Photons, public testing::WithParamInterface<Lit>
{
};

TEST_P(Lights, GivePhotonsTheirPower)
{
    SceneBuilder builder;
    GetParam().build(builder);
    const auto scene = load(builder.compile());
    expectPower(powerOf(emit(*scene, PhotonKind::kGlobal, firstHits()), kAll), GetParam().power,
                GetParam().largest_error, GetParam().name);
}

INSTANTIATE_TEST_SUITE_P(, Lights, testing::ValuesIn(lights()), [](const auto& lit) { return lit.param.name; });

// ---- Where it goes -------------------------------------------------------------------------------------------------

TEST_F(Photons, LoseWhatSurfacesAbsorbAtEveryBounce)
{
    SceneBuilder builder;
    addRoom(builder, with(lambert(1), {{"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.5, 0.2, 1}}}}}));
    builder.light({{"type", "point"}, {"intensity", 1}}, kAbove);
    const auto scene = load(builder.compile());
    PhotonStage::Input in = firstHits();
    std::vector<gpu::Photon> before;
    Double3 expected = 4 * kPi * Double3(1, 1, 1);
    for (in.bounce_limit = 1; in.bounce_limit <= 5; ++in.bounce_limit)
    {
        const auto photons = emit(*scene, PhotonKind::kGlobal, in);
        expectPower(powerOf(without(photons, before), kAll), expected, 0.1,
                    fmt::format("bounce {}", in.bounce_limit).c_str());
        before = photons;
        expected = {0.8 * expected.x, 0.5 * expected.y, 0.2 * expected.z};
    }
}

/// A path from the eye finds light by its cosine to the shading normal, and what is found there is seen by the cosine to the
/// geometric one: photons must agree, or surfaces with normal maps glow (Veach 1997, 5.3).
TEST_F(Photons, LightShadingNormalsAsTheEyeSeesThem)
{
    constexpr double kTilt = 0.5, kAlbedo = 0.9, kInner = 0.1, kOuter = 0.11;
    SceneBuilder builder;
    addRoom(builder, lambert(0.001));
    builder.quad({-0.2f, 1, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f}, builder.material(lambert(kAlbedo)),
                 {float(std::sin(kTilt)), float(std::cos(kTilt)), 0});
    const nlohmann::json cone{{"innerConeAngle", kInner}, {"outerConeAngle", kOuter}};
    builder.light({{"type", "spot"}, {"intensity", 100}, {"spot", cone}},
                  {{"translation", {0, 2.5, 0}}, {"rotation", kDownwards["rotation"]}});
    const auto scene = load(builder.compile());
    PhotonStage::Input in = firstHits();
    const auto arrived = emit(*scene, PhotonKind::kGlobal, in);
    in.bounce_limit = 2;
    const auto photons = emit(*scene, PhotonKind::kGlobal, in);
    const double cosine = std::cos(kTilt), falloff = std::cos(kInner) - std::cos(kOuter);
    const double irradiance =
        100 * 2 * kPi * (1 - std::cos(kInner) + falloff / 3) * cosine; // the beam's mean is straight down
    expectPower(powerOf(arrived, kAll), irradiance * Double3(1, 1, 1), 0.05, "irradiance");
    // Even radiance over the directions above both planes, whose projected solid angle is pi (1 + cosine) / 2.
    expectPower(powerOf(without(photons, arrived), kAll), kAlbedo * irradiance * (1 + cosine) / 2 * Double3(1, 1, 1),
                0.05, "reflected");
}

TEST_F(Photons, PassGlassWithoutLoss)
{
    SceneBuilder builder;
    addRoom(builder, lambert(0.5));
    const nlohmann::json glass{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
                               {"extensions",
                                {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                 {"KHR_materials_volume", {{"thicknessFactor", 0.5}}}}}};
    builder.sphere({0, 1, 0}, 0.8f, 24, true, builder.material(glass));
    builder.light({{"type", "point"}, {"intensity", 1}}, {{"translation", {0, 2.2, 0}}});
    const auto scene = load(builder.compile());
    PhotonStage::Input in = firstHits();
    const auto photons = emit(*scene, PhotonKind::kGlobal, in);
    const Double3 through =
        powerOf(photons, [](const gpu::Photon& p) { return length2(Double3(p.position) - Double3(0, 0, 0)) < 1; }).sum;
    EXPECT_GT(through.x, 0.1 * 4 * kPi); // the sphere focuses on the floor below it what it takes in
    expectPower(powerOf(photons, kAll), 4 * kPi * Double3(1, 1, 1), 0.02, "all");
}

/// Light that a small bright spot 20 view distances away scatters, by the angle to the viewer, against the cosine over pi.
TEST_F(Photons, AreAimedAtTheViewByTheirStatedDensity)
{
    constexpr double kAlbedo = 0.8, kInner = 0.004, kOuter = 0.005;
    SceneBuilder builder;
    builder.box({-40, 0, -40}, {40, 60, 40}, builder.material(lambert(kAlbedo)), true);
    builder.light(
        {{"type", "spot"}, {"intensity", 1e5}, {"spot", {{"innerConeAngle", kInner}, {"outerConeAngle", kOuter}}}},
        {{"translation", {0, 1, 0}}, {"rotation", kDownwards["rotation"]}});
    const auto scene = load(builder.compile());
    const gpu::ViewScale scale{.focus = {20, 5, 0}, .distance = 1};
    submit(*scene, [&](Recorder& rec) { rec.write(scene->viewScale(), 0, std::as_bytes(std::span(&scale, 1))); });
    PhotonStage::Input in = firstHits();
    const auto arrived = emit(*scene, PhotonKind::kGlobal, in);
    in.bounce_limit = 2;
    const auto photons = without(emit(*scene, PhotonKind::kGlobal, in), arrived);
    const double lit = powerOf(arrived, kAll).sum.x;
    const Double3 axis = normalized(Double3(scale.focus)), across(0, 0, 1), up = normalized(Double3(-5, 20, 0));
    // Rings between the cones to the spheres around the viewer, of 1, 2, 4, 8 and 16 view distances, and what lies outside.
    double low = 1, rest = 1;
    for (const double radius : {1.0, 2.0, 4.0, 8.0, 16.0, 0.0})
    {
        const double high = radius > 0 ? std::sqrt(1 - radius * radius / length2(Double3(scale.focus))) : -1;
        constexpr size_t kSteps = 1000;
        double want = 0;
        for (size_t i = 0; i < kSteps; ++i)
            for (size_t k = 0; k < kSteps; ++k)
            {
                const double z = low + (high - low) * (double(i) + 0.5) / kSteps, r = std::sqrt(1 - z * z);
                const double turn = 2 * kPi * (double(k) + 0.5) / kSteps;
                const Double3 d = z * axis + r * std::cos(turn) * across + r * std::sin(turn) * up;
                want += std::max(d.y, 0.0) / kPi * 2 * kPi * (low - high) / (kSteps * kSteps);
            }
        const auto in_ring = [&](const gpu::Photon& p)
        {
            const double z = dot(unpackedNormal(p.direction), axis);
            return z <= low && z > high;
        };
        expectPower(powerOf(photons, in_ring), kAlbedo * lit * want * Double3(1, 1, 1), 0.15,
                    fmt::format("ring of {}", radius).c_str());
        low = high, rest -= want;
    }
    EXPECT_NEAR(rest, 0, 1e-3);
}

TEST_F(Photons, LieOnSurfacesOnTheSideTheyCameFrom)
{
    SceneBuilder builder;
    addRoom(builder, lambert(0.7));
    builder.light({{"type", "point"}, {"intensity", 1}}, kAbove);
    const auto scene = load(builder.compile());
    PhotonStage::Input in = firstHits();
    in.bounce_limit = 3;
    const auto photons = emit(*scene, PhotonKind::kGlobal, in);
    ASSERT_GT(photons.size(), kPaths);
    for (const gpu::Photon& photon : photons)
    {
        const Double3 p = photon.position, n = unpackedNormal(photon.normal);
        EXPECT_LT(dot(n, unpackedNormal(photon.direction)), 0);
        // Distance to the wall whose inward normal this is: 0 to rounding of positions and 16-bit normals.
        const Double3 wall{n.x < 0 ? 2.0 : -2.0, n.y < 0 ? 3.0 : 0.0, n.z < 0 ? 2.0 : -2.0};
        EXPECT_LE(std::abs(dot(n, p - wall)), 3e-4) << p.x << ' ' << p.y << ' ' << p.z;
    }
}

TEST_F(Photons, ContinueTheSequenceOfTheFrameBefore)
{
    SceneBuilder builder;
    addRoom(builder, lambert(0.7));
    builder.quad({-0.4f, 2.5f, -0.25f}, {0.8f, 0, 0}, {0, 0, 0.5f}, builder.material(emitter(5)));
    const auto scene = load(builder.compile());
    PhotonStage::Input whole = firstHits();
    PhotonStage::Input half = whole;
    half.path_count /= 2;
    const auto all = emit(*scene, PhotonKind::kGlobal, whole);
    auto parts = emit(*scene, PhotonKind::kGlobal, half);
    half.first_path = half.path_count;
    const auto second = emit(*scene, PhotonKind::kGlobal, half);
    parts.insert(parts.end(), second.begin(), second.end());
    ASSERT_EQ(all.size(), parts.size());
    for (size_t i = 0; i < all.size(); ++i)
    {
        EXPECT_EQ(length2(Double3(all[i].position) - Double3(parts[i].position)), 0) << i;
        EXPECT_FLOAT_EQ(2 * all[i].power.x, parts[i].power.x) << i;
    }
    half.seed = 2;
    const auto other = emit(*scene, PhotonKind::kGlobal, half);
    size_t equal = 0;
    for (size_t i = 0; i < std::min(other.size(), second.size()); ++i)
        equal += length2(Double3(other[i].position) - Double3(second[i].position)) == 0;
    EXPECT_LT(equal, second.size() / 100);
}

// ---- A full store --------------------------------------------------------------------------------------------------

TEST_F(Photons, OfAsManyPathsAsFitWholeCarryTheLightOfAll)
{
    SceneBuilder builder;
    addRoom(builder, lambert(0.7));
    builder.light({{"type", "point"}, {"intensity", 1}}, kAbove);
    const auto scene = load(builder.compile());
    const PhotonStage::Input in{.path_count = 4096, .first_path = 0, .seed = 3};
    constexpr uint32_t kCapacity = 3000;
    const RayStage rays(device(), *scene);
    const PhotonStage ample(device(), *scene, PhotonKind::kGlobal, in.path_count, 32 * in.path_count),
        stage(device(), *scene, PhotonKind::kGlobal, in.path_count, kCapacity);
    const auto recorded = [&](const PhotonStage& by)
    {
        std::optional<PhotonStage::Output> out;
        submit(*scene, [&](Recorder& rec) { out.emplace(by.record(rec, rays, in)); });
        return *out;
    };
    const auto whole = recorded(ample);
    const auto all = stored(whole);
    const auto counts = contents<uint32_t>(whole.counts, in.path_count);
    EXPECT_EQ(contents<gpu::PhotonStore>(ample.store(), 1)[0].path_count, in.path_count);
    EXPECT_EQ(contents<gpu::PhotonStore>(ample.store(), 1)[0].photon_count, all.size());
    uint32_t paths = 0, photons = 0; // that fit
    while (photons + counts.at(paths) <= kCapacity)
        photons += counts[paths++];
    ASSERT_LT(paths, in.path_count);

    const auto kept = stored(recorded(stage));
    const gpu::PhotonStore store = contents<gpu::PhotonStore>(stage.store(), 1)[0];
    EXPECT_EQ(store.path_count, paths);
    EXPECT_EQ(store.photon_count, photons);
    ASSERT_EQ(kept.size(), photons);
    const double factor = double(in.path_count) / paths;
    for (uint32_t i = 0; i < photons; ++i) // the first paths, each from its light on
    {
        EXPECT_EQ(length2(Double3(kept[i].position) - Double3(all[i].position)), 0) << i;
        EXPECT_EQ(kept[i].direction, all[i].direction);
        EXPECT_NEAR(kept[i].power.x, factor * all[i].power.x, 1e-5 * kept[i].power.x);
    }
    // The power of a map is the sum over independent paths.
    const auto sums = [&](const std::vector<gpu::Photon>& of, uint32_t path_count) -> std::pair<double, double>
    {
        double sum = 0, squares = 0;
        for (uint32_t path = 0, i = 0; path < path_count; ++path)
        {
            double power = 0;
            for (uint32_t end = i + counts[path]; i < end; ++i)
                power += of[i].power.x;
            sum += power;
            squares += power * power;
        }
        return {sum, std::sqrt(squares - sum * sum / path_count)};
    };
    const auto [want, want_error] = sums(all, in.path_count);
    const auto [got, got_error] = sums(kept, paths);
    fmt::print("  {} of {} paths: {:.5g} W of {:.5g} W, standard error {:.2g} W\n", paths, in.path_count, got, want,
               got_error);
    EXPECT_LE(std::abs(got - want), 4 * std::hypot(got_error, want_error));
    EXPECT_LE(got_error, 0.1 * want) << "too few paths to tell";

    const auto again = stored(recorded(stage));
    ASSERT_EQ(again.size(), kept.size());
    EXPECT_EQ(std::memcmp(again.data(), kept.data(), kept.size() * sizeof(gpu::Photon)), 0);
}

// ---- Caustic photons -----------------------------------------------------------------------------------------------

/// A photon of white light that met the red mirrors of the scenes below; red light at grazing incidence stays white
/// only within 1e-5 of 90 degrees.
bool isTinted(const gpu::Photon& photon)
{
    return photon.power.y < 0.9999f * photon.power.x;
}

/// Two mirror spheres, one in front of the other, and a mirror block: their targets overlap.
void addMirrors(SceneBuilder& builder)
{
    const int red = builder.material(mirror(1, 0.3, 0.3));
    builder.sphere({-0.6f, 0.6f, 0}, 0.4f, 16, true, red);
    builder.sphere({-0.5f, 0.7f, 0.9f}, 0.25f, 16, true, red);
    builder.box({0.6f, 0.1f, -0.6f}, {1.1f, 0.7f, -0.2f}, red);
}

struct Aimed
{
    const char* name;
    std::function<void(SceneBuilder&)> build;
};

void PrintTo(const Aimed& value, std::ostream* out) // NOLINT: GoogleTest's name
{
    *out << value.name;
}

std::vector<Aimed> aimedLights()
{
    const auto room = [](SceneBuilder& builder) { addRoom(builder, lambert(0.5)); };
    const auto floor = [](SceneBuilder& builder) { builder.floor(4, 0, builder.material(lambert(0.5))); };
    const auto quad = [](SceneBuilder& builder, const nlohmann::json& material) {
        builder.quad({-0.4f, 2.2f, -0.25f}, {0.8f, 0, 0}, {0, 0, 0.5f}, builder.material(material));
    };
    return {{"Point",
             [=](SceneBuilder& builder)
             {
                 room(builder);
                 builder.light({{"type", "point"}, {"intensity", 1}}, kAbove);
             }},
            {"PointWithinATarget", // between the faces of no mirror, but inside a bounding sphere
             [=](SceneBuilder& builder)
             {
                 room(builder);
                 builder.light({{"type", "point"}, {"intensity", 1}}, {{"translation", {0.85, 0.72, -0.4}}});
             }},
            {"Spot",
             [=](SceneBuilder& builder)
             {
                 room(builder);
                 builder.light(
                     {{"type", "spot"}, {"intensity", 3}, {"spot", {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.6}}}},
                     kDownwards);
             }},
            {"Directional",
             [=](SceneBuilder& builder)
             {
                 floor(builder);
                 builder.light({{"type", "directional"}, {"intensity", 2}},
                               {{"rotation", {-std::sin(kPi / 8), 0, 0, std::cos(kPi / 8)}}});
             }},
            {"Triangle",
             [=](SceneBuilder& builder)
             {
                 room(builder);
                 quad(builder, emitter(5));
             }},
            {"TwoSidedTriangle",
             [=](SceneBuilder& builder)
             {
                 room(builder);
                 builder.quad({0, 0.3f, -0.5f}, {0.2f, 0.1f, 0}, {0, 0.1f, 1},
                              builder.material(with(emitter(5), {{"doubleSided", true}}))); // mirrors on both sides
             }},
            {"Environment",
             [=](SceneBuilder& builder)
             {
                 floor(builder);
                 builder.environment(sky(1, 1, 1));
             }},
            {"Several", [=](SceneBuilder& builder)
             {
                 room(builder);
                 quad(builder, emitter(5));
                 builder.light({{"type", "point"}, {"intensity", 1}}, {{"translation", {-1, 1.5, -1}}});
             }}};
}

class AimedPhotons : public Photons, public testing::WithParamInterface<Aimed>
{
};

TEST_P(AimedPhotons, BringAsMuchToTheSamePlacesAsUnaimedOnes)
{
    SceneBuilder builder;
    GetParam().build(builder);
    addMirrors(builder);
    const auto scene = load(builder.compile());
    ASSERT_GE(scene->info().caustic_target_count, 3u);
    const auto aimed = emit(*scene, PhotonKind::kCaustic, firstHits(1));
    PhotonStage::Input unaimed = firstHits(2);
    unaimed.path_count = kUnaimedPaths;
    const auto global = emit(*scene, PhotonKind::kGlobal, unaimed);
    EXPECT_TRUE(std::ranges::all_of(aimed, isTinted)); // L S+ D alone
    const std::pair<const char*, std::function<bool(const gpu::Photon&)>> places[]{
        {"everywhere", isTinted},
        {"on one side", [](const gpu::Photon& p) { return isTinted(p) && p.position.x > 0; }}};
    for (const auto& [name, wanted] : places)
    {
        const Power a = powerOf(aimed, wanted), b = powerOf(global, wanted, kUnaimedPaths);
        const double error = std::hypot(a.standard_error.x, b.standard_error.x);
        fmt::print("  {}, {}: aimed {:.5g} W ({:.2f} %), unaimed {:.5g} W ({:.2f} %)\n", GetParam().name, name, a.sum.x,
                   100 * a.standard_error.x / a.sum.x, b.sum.x, 100 * b.standard_error.x / b.sum.x);
        EXPECT_LE(std::abs(a.sum.x - b.sum.x), 4 * error) << name;
        EXPECT_LE(std::abs(a.sum.y - b.sum.y), 4 * std::hypot(a.standard_error.y, b.standard_error.y)) << name;
        EXPECT_LE(error, 0.1 * b.sum.x) << name << ": too few photons to tell";
    }
}

INSTANTIATE_TEST_SUITE_P(, AimedPhotons, testing::ValuesIn(aimedLights()),
                         [](const auto& lit) { return lit.param.name; });

TEST_F(Photons, AreNotCausticWithoutMirrorsOrGlass)
{
    SceneBuilder builder;
    addRoom(builder, lambert(0.7));
    builder.light({{"type", "point"}, {"intensity", 1}}, kAbove);
    const auto scene = load(builder.compile());
    EXPECT_TRUE(emit(*scene, PhotonKind::kCaustic, firstHits()).empty());
}
} // namespace
