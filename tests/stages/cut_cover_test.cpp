// What rays feel of the surface around the nodes of an illumination cut: light that would fall beside it is kept on it.
#include "runtime/stages/cut.h"
#include "tests/stages/gi_test.h"
#include "tests/stages/ray_test.h"

#include <numbers>

namespace
{
/// On a strip much narrower than its support a node's light would fall beside it for the most part. Photons lie on
/// backs of surfaces as on fronts.
class CutsOnNarrowSurfaces : public GiTest, public testing::WithParamInterface<bool>
{
};

TEST_P(CutsOnNarrowSurfaces, KeepTheirLight)
{
    constexpr float kWidth = 0.1f, kLength = 4;
    const gpu::vec3 across{0, 0, kWidth}, along{kLength, 0, 0};
    SceneBuilder builder;
    builder.quad({-kLength / 2, 0, -kWidth / 2}, GetParam() ? along : across, GetParam() ? across : along,
                 builder.material(lambert(0.5)));
    const auto scene = load(builder.compile());
    Random random(11);
    std::vector<gpu::Photon> photons;
    for (int i = 0; i < 2000; ++i)
        photons.push_back(
            {.position = {random.between(-kLength / 2, kLength / 2), 0, random.between(-kWidth / 2, kWidth / 2)},
             .direction = packedNormal({0, -1, 0}),
             .power = {1, 1, 1},
             .normal = packedNormal({0, 1, 0})});
    const auto map = mapOf(*scene, photons);
    CutStage::Input in{.mode = CutMode::kLeaves,
                       .iterations = 0,
                       .difference = 0,
                       .photon_count = 800,
                       .radius = 0.4f,
                       .shrink = 1,
                       .probes = 0,
                       .seed = 0};
    const auto cutWith = [&](uint32_t probes)
    {
        in.probes = probes;
        const CutStage stage(device(), *scene, 2000);
        std::optional<CutStage::Output> out;
        submit(*scene, [&](Recorder& rec) { out.emplace(stage.record(rec, map->rays, *map->gpu, in)); });
        return contents<gpu::CutNode>(out->nodes, countOf(out->size));
    };
    const auto flat = cutWith(0), felt = cutWith(64);
    ASSERT_EQ(flat.size(), felt.size());
    // What falls on the strip's own area, by a fine grid; nodes whose disc ends with the strip are left out.
    const auto onStrip = [&](const gpu::CutNode& node)
    {
        constexpr int kSteps = 200;
        double sum = 0;
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j)
            {
                const double x = (2 * (i + 0.5) / kSteps - 1) * node.support, z = ((j + 0.5) / kSteps - 0.5) * kWidth;
                const double dz = z - node.center.z;
                sum += std::max(0.0, 1 - (x * x + dz * dz) / (double(node.support) * node.support));
            }
        return sum * (2 * node.support / kSteps) * (kWidth / kSteps) * node.irradiance.x;
    };
    double before = 0, after = 0, power = 0;
    uint32_t count = 0;
    for (size_t i = 0; i < flat.size(); ++i)
    {
        if (std::abs(flat[i].center.x) + flat[i].support > kLength / 2)
            continue;
        before += onStrip(flat[i]);
        after += onStrip(felt[i]);
        power += 0.5 * std::numbers::pi * flat[i].support * flat[i].support * flat[i].irradiance.x;
        ++count;
    }
    fmt::print("  {} nodes of {:.1f} W: {:.1f} W on the strip, {:.1f} W after probing\n", count, power, before, after);
    ASSERT_GT(count, 20u);
    EXPECT_LT(before, 0.7 * power); // or the test would show nothing
    // 64 rays each: the standard error of one node's covered part p is sqrt(p (1 - p) / 64), below 0.2 p for p > 0.3.
    EXPECT_NEAR(after, power, 4 * 0.2 / std::sqrt(count) * power);
}

INSTANTIATE_TEST_SUITE_P(, CutsOnNarrowSurfaces, testing::Bool(),
                         [](const auto& side) { return side.param ? "FromBehind" : "FromTheFront"; });
} // namespace
