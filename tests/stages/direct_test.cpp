// How direct light chooses its lights: groups, their tables, and candidates; that it adds up is for the other formulas.
#include "runtime/light_groups.h"
#include "tests/stages/closed_form.h"

#include <cmath>

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
    const LightGroups result = groupLights(lights);
    ASSERT_EQ(result.groups.size(), 3u);
    std::vector<double> drawn(lights.size());
    for (const LightGroup& group : result.groups)
    {
        EXPECT_NEAR(group.share, shares[size_t(group.kind)], 1e-6);
        EXPECT_EQ(group.one_place, group.kind == LightKind::kDirectional);
        for (uint32_t i = group.first_pick; i < group.first_pick + group.pick_count; ++i)
        {
            const gpu::LightPick& pick = result.picks[i];
            EXPECT_EQ(lightKind(lights[pick.light]), group.kind);
            drawn[pick.light] += double(group.share) * double(pick.threshold) / group.pick_count;
            drawn[pick.otherwise] += double(group.share) * (1 - double(pick.threshold)) / group.pick_count;
        }
    }
    for (size_t i = 0; i < lights.size(); ++i)
        EXPECT_NEAR(drawn[i], lights[i].pmf, 1e-6) << i;
}

TEST(LightGroups, ALonePunctualLightHasOnePlace)
{
    const auto group = [](uint32_t kind) { return groupLights(std::vector{light(kind, 1)}).groups.at(0); };
    EXPECT_TRUE(group(gpu::kLightPoint).one_place);
    EXPECT_TRUE(group(gpu::kLightDirectional).one_place);
    EXPECT_FALSE(group(gpu::kLightTriangle).one_place);
    EXPECT_FALSE(group(gpu::kLightEnvironment).one_place);
    EXPECT_TRUE(groupLights({}).groups.empty());
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
