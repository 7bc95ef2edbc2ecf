// Final gathering over cuts and photons of known light, against formulas.
#include "runtime/stages/gather.h"
#include "tests/stages/gi_test.h"
#include "tests/stages/gltf_brdf.h"
#include "tests/stages/ray_test.h"
#include "tests/stages/shading_points.h"

#include <numbers>

namespace
{
constexpr double kPi = std::numbers::pi;
constexpr double kAlbedo = 0.6;
constexpr gpu::vec3 kLow{-1, 0, -1.5f}, kHigh{1, 1.5f, 1.5f};
constexpr uint32_t kRays = 64;

/// Samples made by hand.
struct Samples
{
    Buffer size, samples, spheres;
    SamplesStage::Output output() const { return {.size = size, .samples = samples, .spheres = spheres}; }
};

/// Form factor of a rectangle a x b, parallel to a small element at distance c below one of its corners
/// (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-3).
double cornerFormFactor(double a, double b, double c)
{
    const double x = a / c, y = b / c, root_x = std::sqrt(1 + x * x), root_y = std::sqrt(1 + y * y);
    return (x / root_x * std::atan(y / root_x) + y / root_y * std::atan(x / root_y)) / (2 * kPi);
}

class Gather : public GiTest
{
protected:
    /// So wide that its light is even over the room, to 1e-6.
    static gpu::CutNode node(gpu::vec3 center, Double3 normal, gpu::vec3 irradiance)
    {
        return {.center = center, .support = 2000, .irradiance = irradiance, .normal_and_eye = packedCutNormal(normal)};
    }

    /// A node on each of the room's walls. @param irradiance by the wall's inward normal
    template <typename Irradiance>
    static std::vector<gpu::CutNode> wallNodes(Irradiance&& irradiance)
    {
        std::vector<gpu::CutNode> nodes;
        const auto add = [&](gpu::vec3 center, Double3 normal)
        { nodes.push_back(node(center, normal, irradiance(normal))); };
        for (const bool upper : {false, true})
        {
            const double side = upper ? -1 : 1;
            const gpu::vec3 wall = upper ? kHigh : kLow;
            add({wall.x, kHigh.y / 2, 0}, {side, 0, 0});
            add({0, wall.y, 0}, {0, side, 0});
            add({0, kHigh.y / 2, wall.z}, {0, 0, side});
        }
        return nodes;
    }

    static gpu::Sample sampleAt(gpu::vec3 position, Double3 normal)
    {
        return {.position = position,
                .normal = packedNormal(normal),
                .irradiance = {-1, -1, -1},
                .support = 0.1f,
                .harmonic_mean_distance = -1,
                .pixel = 0};
    }

    /// Places on the floor, at least 5 cm from its edges.
    static std::vector<gpu::Sample> floorSamples(uint32_t count)
    {
        Random random(17);
        std::vector<gpu::Sample> samples;
        for (uint32_t i = 0; i < count; ++i)
            samples.push_back(sampleAt(
                {random.between(kLow.x + 0.05f, kHigh.x - 0.05f), 0, random.between(kLow.z + 0.05f, kHigh.z - 0.05f)},
                {0, 1, 0}));
        return samples;
    }

    std::vector<gpu::Sample> gathered(const SceneGpu& scene, const std::vector<gpu::Sample>& samples,
                                      const std::vector<gpu::CutNode>& nodes, CutMode mode = CutMode::kRefined,
                                      uint32_t seed = 1, const std::vector<gpu::Photon>& photons = {},
                                      const std::function<Double3(const gpu::CutNode&)>& direction = {},
                                      const LegsStage* legs = nullptr)
    {
        const uint32_t count = uint32_t(samples.size());
        const auto cut = cutOf(scene, nodes, direction);
        const auto map = mapOf(scene, photons);
        const Samples on_gpu{.size = sizeBuffer(count), .samples = upload("test.samples", samples), .spheres = {}};
        const GatherStage stage(device(), scene, std::max(count, 1u), kRays, kRays);
        submit(scene,
               [&](Recorder& rec)
               {
                   stage.record(rec, map->rays, on_gpu.output(), *map->gpu, *cut->gpu,
                                {.mode = mode,
                                 .ray_count = kRays,
                                 .specular_depth = 8,
                                 .photon_count = 50,
                                 .radius = 5,
                                 .seed = seed,
                                 .legs = legs});
               });
        return contents<gpu::Sample>(on_gpu.samples, count);
    }

    std::unique_ptr<SceneGpu> room(const std::function<void(SceneBuilder&)>& more = {})
    {
        SceneBuilder builder;
        builder.box(kLow, kHigh, builder.material(lambert(kAlbedo)), true);
        if (more)
            more(builder);
        return load(builder.compile());
    }
};

TEST_F(Gather, OfWallsInEvenLightGivesTheirRadiosity)
{
    const auto scene = room();
    std::vector<gpu::Sample> samples = floorSamples(40);
    samples.push_back(sampleAt({kLow.x, 0.7f, 0}, {1, 0, 0}));
    samples.push_back(sampleAt({0.3f, kHigh.y, 0.2f}, {0, -1, 0}));
    samples.push_back(sampleAt({0.3f, 0.4f, 0.2f}, {0.6, 0.64, 0.48}));
    const auto nodes = wallNodes([](Double3) { return gpu::vec3{3, 2, 1}; });
    for (const CutMode mode : {CutMode::kNearest, CutMode::kRefined})
        for (const gpu::Sample& sample : gathered(*scene, samples, nodes, mode))
        {
            EXPECT_NEAR(sample.irradiance.x, 3 * kAlbedo, 1e-5 * 3);
            EXPECT_NEAR(sample.irradiance.y, 2 * kAlbedo, 1e-5 * 3);
            EXPECT_NEAR(sample.irradiance.z, 1 * kAlbedo, 1e-5 * 3);
        }
}

TEST_F(Gather, SeesALitCeilingUnderItsFormFactor)
{
    const auto scene = room();
    const auto samples = floorSamples(64);
    const auto nodes = wallNodes([](Double3 normal) { return normal.y < 0 ? gpu::vec3{1, 1, 1} : gpu::vec3{}; });
    double difference = 0, variance = 0;
    for (const gpu::Sample& sample : gathered(*scene, samples, nodes))
    {
        double factor = 0;
        for (const double x : {double(sample.position.x - kLow.x), double(kHigh.x - sample.position.x)})
            for (const double z : {double(sample.position.z - kLow.z), double(kHigh.z - sample.position.z)})
                factor += cornerFormFactor(x, z, kHigh.y);
        const double deviation = kAlbedo * std::sqrt(factor * (1 - factor) / kRays); // of independent rays
        EXPECT_LE(std::abs(sample.irradiance.x - kAlbedo * factor), 4 * deviation);
        difference += sample.irradiance.x - kAlbedo * factor;
        variance += deviation * deviation;
    }
    fmt::print("  mean difference {:+.5f}, standard deviation of independent rays {:.5f}\n", difference / 64,
               std::sqrt(variance) / 64);
    EXPECT_LE(std::abs(difference), 4 * std::sqrt(variance));
}

/// Legs from a strip of the ceiling to the floor aim rays there. What they bring is the ceiling's light, and its distance, as
/// without them; of a ceiling that is lit in that strip alone it is so with less noise.
TEST_F(Gather, ByAimedRaysGivesTheSameWithLessNoise)
{
    constexpr float kStrip = 0.1f; // metres
    SceneBuilder builder;
    builder.quad({kLow.x, kHigh.y, kLow.z}, {2, 0, 0}, {0, 0, kStrip},
                 builder.material(with(lambert(kAlbedo), {{"doubleSided", true}})));
    builder.quad({kLow.x, 0, kHigh.z}, {2, 0, 0}, {0, 0, -3}, builder.material(lambert(kAlbedo)));
    const auto scene = load(builder.compile());
    Random random(3);
    std::vector<gpu::Photon> photons;
    for (uint32_t i = 0; i < 4 * gpu::kLegCount; ++i)
    {
        const gpu::vec3 from{random.between(kLow.x, kHigh.x), kHigh.y, random.between(kLow.z, kLow.z + kStrip)};
        const gpu::vec3 to{random.between(kLow.x, kHigh.x), 0, random.between(kLow.z, kHigh.z)};
        photons.push_back({.position = from,
                           .direction = packedNormal({0, 1, 0}),
                           .power = {1, 1, 1},
                           .normal = packedNormal({0, -1, 0})});
        photons.push_back({.position = to,
                           .direction = packedNormal(normalized(Double3(to) - Double3(from))),
                           .power = {1, 1, 1},
                           .normal = packedNormal({0, 1, 0})});
    }
    const Paths paths = pathsOf(photons, 2);
    const LegsStage legs(device());
    submit(*scene, [&](Recorder& rec) { legs.record(rec, paths.output(), 1); });
    const auto samples = floorSamples(200);
    const auto nodes = wallNodes([](Double3 normal) { return normal.y < 0 ? gpu::vec3{1, 1, 1} : gpu::vec3{}; });
    const auto errorsOf = [&](const LegsStage* aimed, double& mean, double& squares)
    {
        mean = squares = 0;
        for (const gpu::Sample& sample : gathered(*scene, samples, nodes, CutMode::kRefined, 1, {}, {}, aimed))
        {
            double factor = 0;
            for (const double x : {double(sample.position.x - kLow.x), double(kHigh.x - sample.position.x)})
                factor += cornerFormFactor(x, sample.position.z - kLow.z, kHigh.y) -
                          std::copysign(cornerFormFactor(x, std::abs(sample.position.z - kLow.z - kStrip), kHigh.y),
                                        sample.position.z - kLow.z - kStrip);
            const double error = sample.irradiance.x - kAlbedo * factor;
            mean += error / 200;
            squares += error * error / 200;
        }
    };
    double mean, squares, aimed_mean, aimed_squares;
    errorsOf(nullptr, mean, squares);
    errorsOf(&legs, aimed_mean, aimed_squares);
    fmt::print("  mean error {:+.5f}, aimed {:+.5f}; mean square {:.3g}, aimed {:.3g}\n", mean, aimed_mean, squares,
               aimed_squares);
    EXPECT_LE(std::abs(aimed_mean), 4 * std::sqrt(aimed_squares / 200));
    EXPECT_LT(aimed_squares, 0.5 * squares);
}

/// What pixels gather for themselves does not depend on how many there is room for at once; in even light it is radiosity.
TEST_F(Gather, OfPixelsIsTheSameInOnePassAndInMany)
{
    constexpr uint32_t kWidth = 24, kHeight = 20, kPixels = kWidth * kHeight;
    SceneBuilder builder;
    builder.box(kLow, kHigh, builder.material(lambert(kAlbedo)), true);
    const auto path = builder.compile();
    const auto scene = load(path);
    const Camera camera{.name = "",
                        .position = {0, 0.7f, 1.4f},
                        .forward = {0, 0, -1},
                        .up = {0, 1, 0},
                        .vertical_fov = 1.2f,
                        .orthographic_height = 0};
    const ShadingPoints points(device(), *scene, path, camera, kWidth, kHeight);
    const auto map = mapOf(*scene, {});
    const auto pixels = [&](uint32_t room, const std::vector<gpu::CutNode>& nodes)
    {
        const auto cut = cutOf(*scene, nodes);
        const GatherStage stage(device(), *scene, 1, room, room);
        EXPECT_EQ(stage.raysPerPixel(kPixels), 1u);
        const Buffer radiance = upload("test.radiance", std::vector<gpu::vec3>(kPixels));
        submit(*scene,
               [&](Recorder& rec)
               {
                   stage.recordPixels(rec, map->rays, *map->gpu, *cut->gpu,
                                      {.mode = CutMode::kRefined,
                                       .ray_count = room,
                                       .specular_depth = 8,
                                       .photon_count = 50,
                                       .radius = 5,
                                       .seed = 1},
                                      {.points = points.gpu->points,
                                       .radiance = radiance,
                                       .point_count = kPixels,
                                       .frame = 3,
                                       .seed = 7});
               });
        return contents<gpu::vec3>(radiance, kPixels);
    };
    const auto even = wallNodes([](Double3) { return gpu::vec3{3, 2, 1}; });
    for (const gpu::vec3& pixel : pixels(kPixels / 7 + 1, even))
        for (const auto& [got, irradiance] : {std::pair{pixel.x, 3.0}, {pixel.y, 2.0}, {pixel.z, 1.0}})
            EXPECT_NEAR(got, kAlbedo * kAlbedo * irradiance / kPi, 1e-5);
    const auto lit_above = wallNodes([](Double3 normal) { return normal.y < 0 ? gpu::vec3{1, 1, 1} : gpu::vec3{}; });
    const auto once = pixels(kPixels, lit_above), often = pixels(kPixels / 7 + 1, lit_above);
    uint32_t lit = 0;
    for (uint32_t i = 0; i < kPixels; ++i)
    {
        EXPECT_FLOAT_EQ(once[i].x, often[i].x) << i;
        lit += once[i].x > 0;
    }
    EXPECT_GT(lit, kPixels / 10);
    EXPECT_LT(lit, kPixels * 9 / 10);
}

/// Light from one side on a rough ceiling: what of it comes down is up to the BRDF.
TEST_F(Gather, SeesRoughSurfacesByTheirBrdf)
{
    const GltfMaterial plastic{.base_color = {0.3, 0.3, 0.3}, .roughness = 0.6};
    SceneBuilder builder;
    builder.box(kLow, kHigh,
                builder.material({{"pbrMetallicRoughness",
                                   {{"baseColorFactor", {0.3, 0.3, 0.3, 1}},
                                    {"metallicFactor", 0},
                                    {"roughnessFactor", plastic.roughness}}}}),
                true);
    const auto scene = load(builder.compile());
    const Double3 place{0.1, 0, -0.2}, light = normalized({0.9, -0.3, 0.1}); // towards the light, below the ceiling
    const auto nodes = wallNodes([](Double3 normal) { return normal.y < 0 ? gpu::vec3{1, 1, 1} : gpu::vec3{}; });
    constexpr uint32_t kSamples = 400;
    const std::vector<gpu::Sample> samples(kSamples, sampleAt({float(place.x), 0, float(place.z)}, {0, 1, 0}));
    double sum = 0, squares = 0;
    for (const gpu::Sample& sample :
         gathered(*scene, samples, nodes, CutMode::kRefined, 1, {}, [&](const gpu::CutNode&) { return -1 * light; }))
    {
        sum += sample.irradiance.x;
        squares += double(sample.irradiance.x) * sample.irradiance.x;
    }
    double want = 0; // the integral over the ceiling, of 200 x 200 patches
    constexpr int kPatches = 200;
    const double width = kHigh.x - kLow.x, depth = kHigh.z - kLow.z, patch = width * depth / (kPatches * kPatches);
    for (int i = 0; i < kPatches; ++i)
        for (int k = 0; k < kPatches; ++k)
        {
            const Double3 to =
                Double3{kLow.x + width * (i + 0.5) / kPatches, kHigh.y, kLow.z + depth * (k + 0.5) / kPatches} - place;
            const Double3 d = normalized(to); // local to the ceiling: its z is -y
            const double f = gltfBrdf(plastic, {-d.x, -d.z, d.y}, {light.x, light.z, -light.y})[0];
            want += f * d.y * d.y / length2(to) * patch;
        }
    const double mean = sum / kSamples, error = std::sqrt((squares / kSamples - mean * mean) / kSamples);
    fmt::print("  {:.5f} of {:.5f} W/m^2, standard error {:.5f}\n", mean, want, error);
    EXPECT_LT(error, 0.01 * want);
    EXPECT_NEAR(mean, want, 4 * error + 1e-3 * want); // and the octahedral direction's rounding
}

/// Distance from x along d to the walls of a box around it, or to those of them that `exists` says; 0: nothing there.
double distanceToWalls(Double3 x, Double3 d, const std::function<bool(int, bool)>& exists)
{
    const double from[]{x.x, x.y, x.z}, along[]{d.x, d.y, d.z}, low[]{kLow.x, kLow.y, kLow.z},
        high[]{kHigh.x, kHigh.y, kHigh.z};
    double nearest = 1e30;
    bool is_there = false;
    for (int axis = 0; axis < 3; ++axis)
    {
        const bool upper = along[axis] > 0;
        const double t = along[axis] == 0 ? 1e30 : ((upper ? high[axis] : low[axis]) - from[axis]) / along[axis];
        if (t < nearest)
            nearest = t, is_there = exists(axis, upper);
    }
    return is_there ? nearest : 0;
}

TEST_F(Gather, FindsTheHarmonicMeanDistance)
{
    SceneBuilder open; // a floor and one wall
    open.quad({kLow.x, 0, kHigh.z}, {2, 0, 0}, {0, 0, -3}, open.material(lambert(kAlbedo)));
    open.quad({kLow.x, 0, kLow.z}, {2, 0, 0}, {0, 1.5f, 0}, open.material(lambert(kAlbedo)));
    const auto open_scene = load(open.compile());
    const auto closed_scene = room();
    const auto samples = floorSamples(64);
    for (const bool closed : {true, false})
    {
        const auto exists = [&](int axis, bool upper) { return closed || (axis == 2 && !upper); };
        double difference = 0, variance = 0;
        for (const gpu::Sample& sample : gathered(closed ? *closed_scene : *open_scene, samples, {}))
        {
            double sum = 0, squares = 0;
            constexpr int kSteps = 100; // stratified: a hundred times fewer errors than the kernel's rays
            for (int i = 0; i < kSteps; ++i)
                for (int k = 0; k < kSteps; ++k)
                {
                    const double r2 = (i + 0.5) / kSteps, phi = 2 * kPi * (k + 0.5) / kSteps, r = std::sqrt(r2);
                    const double t = distanceToWalls(sample.position,
                                                     {r * std::cos(phi), std::sqrt(1 - r2), r * std::sin(phi)}, exists);
                    const double nearness = t > 0 ? 1 / t : 0;
                    sum += nearness;
                    squares += nearness * nearness;
                }
            const double mean = sum / (kSteps * kSteps),
                         deviation = std::sqrt((squares / (kSteps * kSteps) - mean * mean) / kRays);
            EXPECT_TRUE(std::isfinite(sample.harmonic_mean_distance));
            EXPECT_LE(std::abs(1 / sample.harmonic_mean_distance - mean), 4 * deviation) << closed;
            difference += 1 / sample.harmonic_mean_distance - mean;
            variance += deviation * deviation;
        }
        fmt::print("  {}: mean difference {:+.5f} 1/m, standard deviation of independent rays {:.5f} 1/m\n",
                   closed ? "closed" : "open", difference / 64, std::sqrt(variance) / 64);
        EXPECT_LE(std::abs(difference), 4 * std::sqrt(variance));
    }
}

TEST_F(Gather, TakesNothingFromEmittersDirectlyOrThroughMirrors)
{
    const auto scene = room(
        [](SceneBuilder& builder)
        {
            builder.quad({-0.9f, 1.4f, -1.4f}, {1.8f, 0, 0}, {0, 0, 2.8f},
                         builder.material(with(emitter(100), {{"doubleSided", true}})));
            builder.sphere({0, 0.5f, 0}, 0.4f, 16, true, builder.material(mirror(1, 1, 1)));
            builder.light({{"type", "point"}, {"intensity", 100}}, {{"translation", {0.5, 0.5, 0.5}}});
            ImageF sky{8, 4, std::vector<float>(3 * 32, 5.0f)};
            builder.environment(sky);
        });
    for (const gpu::Sample& sample : gathered(*scene, floorSamples(20), wallNodes([](Double3) { return gpu::vec3{}; })))
    {
        EXPECT_EQ(sample.irradiance.x, 0);
        EXPECT_EQ(sample.irradiance.y, 0);
        EXPECT_EQ(sample.irradiance.z, 0);
    }
}

TEST_F(Gather, SeesWallsThroughMirrors)
{
    const auto scene = room(
        [](SceneBuilder& builder) {
            builder.sphere({0, 0.7f, 0}, 0.5f, 16, false, builder.material(mirror(1, 1, 1)));
        });
    const auto nodes = wallNodes([](Double3) { return gpu::vec3{2, 2, 2}; });
    for (const gpu::Sample& sample : gathered(*scene, floorSamples(20), nodes))
        EXPECT_NEAR(sample.irradiance.x, 2 * kAlbedo, 1e-5 * 2);
}

TEST_F(Gather, ReadsTheNearestNodeThatFacesTheSameWayInModeNearest)
{
    const auto scene = room();
    const gpu::vec3 x{0, kHigh.y, 0};
    std::vector<gpu::CutNode> nodes{node(x, {0, -1, 0}, {1, 1, 1}), node({0, 0, 0}, {0, 1, 0}, {9, 9, 9})};
    for (const Double3 n : {Double3(1, 0, 0), Double3(-1, 0, 0), Double3(0, 0, 1), Double3(0, 0, -1)})
        nodes.push_back(node({float(-n.x), 0.7f, float(-1.5 * n.z)}, n, {1, 1, 1})); // the wall it faces away from
    for (const gpu::Sample& sample : gathered(*scene, floorSamples(20), nodes, CutMode::kNearest))
        EXPECT_NEAR(sample.irradiance.x, kAlbedo, 1e-5); // never the floor's, which faces the other way
}

TEST_F(Gather, EstimatesTheDensityOfPhotonsInModeKnn)
{
    const auto scene = room();
    std::vector<gpu::Photon> photons; // a grid on the ceiling: 1 W/m^2
    constexpr int kSide = 60;
    for (int i = 0; i < kSide; ++i)
        for (int k = 0; k < kSide; ++k)
            photons.push_back(
                {.position = {kLow.x + 2 * (float(i) + 0.5f) / kSide, kHigh.y, kLow.z + 3 * (float(k) + 0.5f) / kSide},
                 .direction = packedNormal({0, 1, 0}),
                 .power = {6.0f / (kSide * kSide), 3.0f / (kSide * kSide), 0},
                 .normal = packedNormal({0, -1, 0})});
    const auto samples = floorSamples(30);
    const auto knn = gathered(*scene, samples, {}, CutMode::kKnn, 1, photons);
    const auto lit = gathered(*scene, samples,
                              wallNodes(
                                  [](Double3 normal) {
                                      return normal.y < 0 ? gpu::vec3{1, 0.5f, 0} : gpu::vec3{};
                                  }));
    double sum = 0, expected = 0;
    for (size_t i = 0; i < samples.size(); ++i) // the same rays: they differ by the estimate only
    {
        sum += knn[i].irradiance.x;
        expected += lit[i].irradiance.x;
        EXPECT_NEAR(knn[i].irradiance.y, 0.5 * knn[i].irradiance.x, 1e-6);
        EXPECT_EQ(knn[i].irradiance.z, 0);
    }
    fmt::print("  density estimates give {:.4f} of the truth\n", sum / expected);
    // 50 of 3600 photons reach 0.16 m: within that of an edge, a strip of 28 % of the ceiling, up to half of a disc is
    // empty.
    EXPECT_LE(sum, 1.02 * expected);
    EXPECT_GE(sum, (1 - 0.28 / 2) * expected);
}

TEST_F(Gather, LeavesNothingUndefinedWithoutSamplesPhotonsOrNodes)
{
    const auto scene = room();
    EXPECT_TRUE(gathered(*scene, {}, {}).empty());
    for (const CutMode mode : {CutMode::kKnn, CutMode::kNearest, CutMode::kRefined})
        for (const gpu::Sample& sample : gathered(*scene, floorSamples(3), {}, mode))
            EXPECT_EQ(sample.irradiance.x, 0);
}

TEST_F(Gather, IsTheSameForTheSameSeed)
{
    const auto scene = room();
    const auto samples = floorSamples(20);
    const auto nodes = wallNodes([](Double3 normal) { return normal.x < 0 ? gpu::vec3{1, 1, 1} : gpu::vec3{}; });
    const auto one = gathered(*scene, samples, nodes), again = gathered(*scene, samples, nodes),
               other = gathered(*scene, samples, nodes, CutMode::kRefined, 2);
    uint32_t equal = 0;
    for (size_t i = 0; i < samples.size(); ++i)
    {
        EXPECT_EQ(one[i].irradiance.x, again[i].irradiance.x);
        EXPECT_EQ(one[i].harmonic_mean_distance, again[i].harmonic_mean_distance);
        equal += one[i].harmonic_mean_distance == other[i].harmonic_mean_distance;
    }
    EXPECT_LT(equal, samples.size() / 2);
}
} // namespace
