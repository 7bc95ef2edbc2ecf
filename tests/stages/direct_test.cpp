// How direct light chooses its lights: groups, their tables, and candidates; that it adds up is for the other formulas.
#include "runtime/light_clusters.h"
#include "runtime/light_groups.h"
#include "tests/stages/closed_form.h"

#include <cmath>
#include <set>

namespace
{
constexpr double kAlbedo = 0.5;

gpu::Light light(uint32_t kind, float pmf)
{
    gpu::Light light{};
    light.kind = kind;
    light.pmf = pmf;
    return light;
}

TEST(LightGroups, PickEachLightByItsShareOfTheGroup)
{
    const std::vector<gpu::Light> lights{light(gpu::kLightDirectional, 0.3f), light(gpu::kLightPoint, 0.125f),
                                         light(gpu::kLightTriangle, 0.25f),   light(gpu::kLightSpot, 0),
                                         light(gpu::kLightPoint, 0.125f),     light(gpu::kLightEnvironment, 0.2f)};
    const std::vector<double> shares{0.3, 0.2, 0.5}; // of directional, environment and local lights
    const std::vector<uint32_t> clusters{0, 0, 3, 0, 3, 0};
    const LightGroups result = groupLights(lights, clusters);
    ASSERT_EQ(result.groups.size(), 3u);
    std::vector<double> drawn(lights.size());
    for (const LightGroup& group : result.groups)
    {
        EXPECT_EQ(group.one_place, group.kind == LightKind::kDirectional);
        EXPECT_EQ(group.cluster_count, group.kind == LightKind::kLocal ? 2u : 1u);
        double sum = 0;
        for (uint32_t c = group.first_cluster; c < group.first_cluster + group.cluster_count; ++c)
        {
            const gpu::LightCluster& cluster = result.clusters[c];
            sum += double(cluster.share);
            for (uint32_t i = cluster.first_pick; i < cluster.first_pick + cluster.pick_count; ++i)
            {
                const gpu::LightPick& pick = result.picks[i];
                EXPECT_EQ(lightKind(lights[pick.light]), group.kind);
                EXPECT_EQ(clusters[pick.light], clusters[pick.otherwise]);
                EXPECT_NEAR(result.densities[pick.light], 1 / cluster.share, 1e-5);
                drawn[pick.light] += double(cluster.share) * double(pick.threshold) / cluster.pick_count;
                drawn[pick.otherwise] += double(cluster.share) * (1 - double(pick.threshold)) / cluster.pick_count;
            }
        }
        EXPECT_NEAR(sum, shares[size_t(group.kind)], 1e-6);
    }
    for (size_t i = 0; i < lights.size(); ++i)
        EXPECT_NEAR(drawn[i], lights[i].pmf, 1e-6) << i;
}

TEST(LightGroups, ALonePunctualLightHasOnePlace)
{
    const auto group = [](uint32_t kind)
    { return groupLights(std::vector{light(kind, 1)}, std::vector<uint32_t>(1)).groups.at(0); };
    EXPECT_TRUE(group(gpu::kLightPoint).one_place);
    EXPECT_TRUE(group(gpu::kLightDirectional).one_place);
    EXPECT_FALSE(group(gpu::kLightTriangle).one_place);
    EXPECT_FALSE(group(gpu::kLightEnvironment).one_place);
    EXPECT_TRUE(groupLights({}, {}).groups.empty());
}

class DirectLight : public ClosedForm
{
protected:
    static constexpr uint32_t kSide = 64;

    /// Independent estimates of the light at one point.
    Estimate oneFrame(const SceneGpu& scene, uint32_t candidates, uint32_t samples)
    {
        Settings settings;
        settings.direct_candidates = candidates;
        settings.direct_samples = samples;
        return estimate(render(scene, viewOf({0, 0, 0}, {0, 1, 0}), settings, 1, kSide, kSide, Mode::kDirect));
    }
};

/// A lamp behind a wall does not take the shadow rays of the one that is seen, however bright it is.
TEST_F(DirectLight, ALampBehindAWallAddsNoNoise)
{
    std::array<Estimate, 2> estimates; // without and with it
    for (const bool with : {false, true})
    {
        SceneBuilder builder;
        builder.floor(20, 0, builder.material(lambert(kAlbedo)));
        const int lamp = builder.material(emitter(1));
        builder.quad({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, lamp);
        builder.quad({2, -1, -10}, {0, 4, 0}, {0, 0, 20}, builder.material(lambert(kAlbedo)));
        if (with)
            builder.quad({2.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, builder.material(emitter(1000)));
        estimates[with] = oneFrame(*load(builder.compile()), 8, 1);
        fmt::print("  {} it: {:.4f} +- {:.4f}\n", with ? "with" : "without", estimates[with].mean[0],
                   estimates[with].standard_error[0]);
    }
    const double error = std::hypot(estimates[0].standard_error[0], estimates[1].standard_error[0]);
    EXPECT_NEAR(estimates[1].mean[0], estimates[0].mean[0], 4 * error);
    // A variance of 4096 values is accurate to 2 % for a normal distribution; more for one with tails.
    EXPECT_LE(estimates[1].standard_error[0], 1.1 * estimates[0].standard_error[0]);
}

/// The tile's rays may miss a lamp that some of its pixels see: those get their light from the ray that goes to the rest.
TEST_F(DirectLight, WhatFewPixelsSeeIsNotLost)
{
    SceneBuilder builder;
    builder.floor(20, 0, builder.material(lambert(kAlbedo)));
    builder.light({{"type", "point"}, {"intensity", 1}}, {{"translation", {-0.2, 1, 0}}});
    builder.light({{"type", "point"}, {"intensity", 300}}, {{"translation", {4, 1, 0}}});
    // Light of the second lamp reaches a strip of the picture, a pixel or two wide: between two walls' shadows.
    builder.quad({2, 0.55f, -10}, {0, 4, 0}, {0, 0, 20}, builder.material(lambert(kAlbedo)));
    builder.quad({2, -1, -10}, {0, 1.54f, 0}, {0, 0, 20}, builder.material(lambert(kAlbedo)));
    const auto scene = load(builder.compile());
    Settings settings;
    const Picture picture =
        render(*scene, viewOf({0, 0, 0}, {0, 1, 0}, 0.5f, 2), settings, 64, kSide, kSide, Mode::kDirect);
    double got = 0, want = 0;
    uint32_t lit = 0;
    constexpr uint32_t kFine = 32; // points of a pixel, along x
    for (uint32_t x = 0; x < kSide; ++x)
        for (uint32_t i = 0; i < kFine; ++i)
        {
            const double at = ((x + (i + 0.5) / kFine) / kSide - 0.5) * 2;
            const auto irradiance = [&](double lamp, double intensity, double z)
            { return intensity / std::pow((lamp - at) * (lamp - at) + 1 + z * z, 1.5); };
            const double height = 1 - 2 / (4 - at); // of the ray to the second lamp, at the wall
            const bool passes = height > 0.54 && height < 0.55;
            lit += passes;
            for (uint32_t y = 0; y < kSide; ++y)
            {
                const double z = ((y + 0.5) / kSide - 0.5) * 2;
                want += kAlbedo / kPi * (irradiance(-0.2, 1, z) + (passes ? irradiance(4, 300, z) : 0)) / kFine;
            }
        }
    for (const gpu::vec3& pixel : picture.pixels)
        got += double(pixel.x);
    fmt::print("  {:.1f} of {} columns see the second lamp: {:.5f} of what they should show\n", double(lit) / kFine,
               kSide, got / want);
    EXPECT_GT(lit, 0u);
    EXPECT_NEAR(got / want, 1, kTolerance);
}

TEST(LightClusters, AreObjectsWhereThereAreFew)
{
    const auto triangle = [](float x, bool second) -> gpu::Light
    {
        return {.p0 = {x, 0, 0},
                .kind = gpu::kLightTriangle,
                .p1 = second ? gpu::vec3{x + 1, 1, 0} : gpu::vec3{x + 1, 0, 0},
                .triangle = 0,
                .p2 = second ? gpu::vec3{x, 1, 0} : gpu::vec3{x + 1, 1, 0},
                .pmf = 0.1f};
    };
    const auto point = [](float x, uint32_t kind) -> gpu::Light {
        return {.p0 = {x, 0, 0}, .kind = kind, .pmf = 0.1f};
    };
    const std::vector<gpu::Light> lights{triangle(0, false),
                                         triangle(3, false),
                                         triangle(0, true),
                                         point(1, gpu::kLightPoint),
                                         point(1, gpu::kLightPoint),
                                         point(7, gpu::kLightSpot),
                                         point(0, gpu::kLightDirectional),
                                         triangle(3, true)};
    const std::vector<uint32_t> clusters = clusterLights(lights);
    EXPECT_EQ(clusters[0], clusters[2]);
    EXPECT_EQ(clusters[1], clusters[7]);
    EXPECT_EQ(std::set({clusters[0], clusters[1], clusters[3], clusters[5]}).size(), 4u);
}

TEST(LightClusters, AreNearEachOtherWhereThereAreMany)
{
    std::vector<gpu::Light> lights;
    for (int room = 0; room < 4; ++room)
        for (int lamp = 0; lamp < 25; ++lamp)
            lights.push_back({.p0 = {100.f * float(room) + float(lamp % 5), 0, float(lamp / 5)},
                              .kind = gpu::kLightPoint,
                              .pmf = 0.01f});
    const std::vector<uint32_t> clusters = clusterLights(lights);
    std::array<std::set<size_t>, gpu::kMostClusters> rooms;
    for (size_t i = 0; i < lights.size(); ++i)
        rooms.at(clusters[i]).insert(i / 25);
    for (const std::set<size_t>& of_cluster : rooms)
        EXPECT_EQ(of_cluster.size(), 1u) << "every cluster is used, by one room";
}

/// Nothing is in the way, so that the weighted sum over all candidates is what the pixel shows: its variance is that of the
/// mean of as many independent samples, or less where they are well spread.
TEST_F(DirectLight, CandidatesCountLikeSamplesWhereNothingIsInTheWay)
{
    SceneBuilder builder;
    builder.floor(20, 0, builder.material(lambert(kAlbedo)));
    builder.light({{"type", "directional"}, {"intensity", 3}}, {{"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}});
    double irradiance = 3;
    for (int i = 0; i < 32; ++i)
    {
        const double x = 0.25 * i, intensity = 1 + i % 5, distance2 = x * x + 1;
        builder.light({{"type", "point"}, {"intensity", intensity}}, {{"translation", {x, 1, 0}}});
        irradiance += intensity / (distance2 * std::sqrt(distance2));
    }
    const auto scene = load(builder.compile());
    const double want = kAlbedo / kPi * irradiance;
    const Estimate one = oneFrame(*scene, 1, 1);
    for (const uint32_t count : {4u, 16u})
    {
        const Estimate candidates = oneFrame(*scene, count, 1), samples = oneFrame(*scene, 1, count);
        const double gain = one.standard_error[0] / candidates.standard_error[0];
        fmt::print("  {} candidates: mean {:.4f} of {:.4f}, {:.2f} times less deviation; as many samples: {:.2f}\n",
                   count, candidates.mean[0], want, gain, one.standard_error[0] / samples.standard_error[0]);
        EXPECT_NEAR(candidates.mean[0], want, 4 * candidates.standard_error[0]);
        EXPECT_GE(gain, std::sqrt(count));
    }
}
} // namespace
