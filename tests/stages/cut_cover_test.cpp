// Coverage probe rays estimate the fraction of a cut node's disc that lies on the surface, so that no power is spread beside it.
#include "tests/stages/cut_twin.h"
#include "tests/stages/ray_test.h"

#include <numbers>

namespace
{
/// On a strip much narrower than its support a node's light would fall beside it for the most part. Photons lie on
/// backs of surfaces as on fronts.
class CutsOnNarrowSurfaces : public CutTest, public testing::WithParamInterface<bool>
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
        photons.push_back(photonAt(
            {random.between(-kLength / 2, kLength / 2), 0, random.between(-kWidth / 2, kWidth / 2)}, {0, 1, 0}));
    const auto map = mapOf(*scene, photons);
    CutStage::Input in{.mode = CutMode::kLeaves,
                       .iterations = 0,
                       .difference = 0,
                       .photon_count = 800,
                       .radius = 0.1f,
                       .shrink = 1,
                       .probes = 0,
                       .rim_probes = 12,
                       .seed = 0};
    const auto cutWith = [&](uint32_t probes)
    {
        in.probes = probes;
        return nodesOf(*scene, *map, in);
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
                sum += cutWeight(node, {node.center.x + x, 0, z}, {0, 1, 0});
            }
        return sum * (2 * node.support / kSteps) * (kWidth / kSteps) * node.irradiance.x;
    };
    double before = 0, after = 0, power = 0;
    uint32_t count = 0;
    for (size_t i = 0; i < flat.size(); ++i)
    {
        if (std::abs(flat[i].center.x) + flat[i].support > kLength / 2)
            continue;
        EXPECT_GT(eyeHeight(felt[i]), 0);
        EXPECT_FALSE(isClear(felt[i]));
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

// ---- Eyes ----------------------------------------------------------------------------------------------------------

class CutsProbed : public CutTest
{
protected:
    static constexpr CutStage::Input kInput{.mode = CutMode::kLeaves,
                                            .iterations = 0,
                                            .difference = 0,
                                            .photon_count = 50,
                                            .radius = 0.2f,
                                            .shrink = 1,
                                            .probes = 16,
                                            .rim_probes = 12,
                                            .seed = 2};
};

/// In a shallow valley parts of a disc hide what lies below it, and what rises before it hides parts of the disc.
TEST_F(CutsProbed, KeepTheirLightOnABentSurface)
{
    constexpr float kSlope = 0.25f, kHalf = 1;
    SceneBuilder builder;
    const int material = builder.material(lambert(0.5));
    for (const float side : {-1.0f, 1.0f})
        builder.quad({0, 0, -kHalf}, {side * kHalf, kSlope * kHalf, 0}, {0, 0, 2 * kHalf}, material);
    const auto scene = load(builder.compile());
    Random random(19);
    std::vector<gpu::Photon> photons;
    for (int i = 0; i < 3000; ++i)
    {
        const float x = random.between(-kHalf, kHalf);
        photons.push_back(photonAt({x, kSlope * std::abs(x), random.between(-kHalf, kHalf)},
                                   normalized({x > 0 ? -kSlope : kSlope, 1, 0})));
    }
    const auto map = mapOf(*scene, photons);
    CutStage::Input in = kInput;
    in.photon_count = 100;
    in.probes = 64;
    double received = 0, power = 0, unprobed = 0;
    uint32_t count = 0;
    const auto receivedOf = [&](const gpu::CutNode& node) // what the valley gets, by a fine grid
    {
        constexpr int kSteps = 120;
        const double step = 2.0 * node.support / kSteps;
        double sum = 0;
        for (int i = 0; i < kSteps; ++i)
            for (int k = 0; k < kSteps; ++k)
            {
                const double x = node.center.x + (i + 0.5) * step - node.support,
                             z = node.center.z + (k + 0.5) * step - node.support;
                sum += cutWeight(node, {x, kSlope * std::abs(x), z}, normalized({x > 0 ? -kSlope : kSlope, 1, 0}));
            }
        return sum * step * step * std::sqrt(1 + kSlope * kSlope) * node.irradiance.x;
    };
    in.fewest = 1; // every node is a photon, of 1 W
    for (const gpu::CutNode& node : nodesOf(*scene, *map, in))
    {
        const double distance = std::abs(node.center.x); // from the bottom
        if (distance > 0.6 * node.support || std::abs(node.center.z) > kHalf - node.support)
            continue;
        received += receivedOf(node);
        gpu::CutNode plain = node;
        plain.irradiance.x = float(1 / (0.5 * std::numbers::pi * node.support * node.support));
        unprobed += receivedOf(plain);
        power += 1;
        ++count;
    }
    fmt::print("  {} nodes of {:.0f} W: {:.1f} W received, {:.1f} W without probing\n", count, power, received,
               unprobed);
    ASSERT_GT(count, 50u);
    EXPECT_LT(unprobed, 0.9 * power); // or the test would show nothing
    // As above: 64 rays each.
    EXPECT_NEAR(received, power, 4 * 0.2 / std::sqrt(count) * power);
}

TEST_F(CutsProbed, AreClearWhereNothingStandsOnTheirDiscs)
{
    constexpr float kHalf = 1;
    SceneBuilder builder;
    const int material = builder.material(lambert(0.5));
    builder.floor(2 * kHalf, 0, material);
    builder.quad({0, 0, -kHalf}, {0, 0.5f, 0}, {0, 0, 2 * kHalf}, material);
    const auto scene = load(builder.compile());
    Random random(29);
    std::vector<gpu::Photon> photons;
    for (int i = 0; i < 3000; ++i)
        photons.push_back(photonAt({random.between(-kHalf, kHalf), 0, random.between(-kHalf, kHalf)}, {0, 1, 0}));
    const auto map = mapOf(*scene, photons);
    uint32_t clear = 0, walled = 0;
    for (const gpu::CutNode& node : nodesOf(*scene, *map, kInput))
    {
        const double to_wall = std::abs(node.center.x),
                     to_edge = kHalf - std::max(std::abs(node.center.x), std::abs(node.center.z));
        if (to_wall > 1.001 * node.support && to_edge > 1.001 * node.support)
        {
            EXPECT_TRUE(isClear(node));
            ++clear;
        }
        // Closer than that one of 12 rays to the rim meets the wall: it takes a third of the rim.
        if (to_wall < 0.5 * node.support)
        {
            EXPECT_FALSE(isClear(node));
            ++walled;
        }
    }
    fmt::print("  {} nodes clear, {} at the wall\n", clear, walled);
    EXPECT_GT(clear, 100u);
    EXPECT_GT(walled, 20u);
}

TEST_F(CutsProbed, AreSeenFromHalfWayToWhatIsAboveThem)
{
    constexpr float kHalf = 1, kLow = 0.01f, kSlope = 0.06f; // of the ceiling
    SceneBuilder builder;
    const int material = builder.material(lambert(0.5));
    builder.floor(2 * kHalf, 0, material);
    builder.quad({-kHalf, kLow, -kHalf}, {2 * kHalf, 2 * kSlope * kHalf, 0}, {0, 0, 2 * kHalf}, material);
    const auto scene = load(builder.compile());
    Random random(31);
    std::vector<gpu::Photon> photons;
    for (int i = 0; i < 1000; ++i)
        photons.push_back(photonAt({random.between(-kHalf, kHalf), 0, random.between(-kHalf, kHalf)}, {0, 1, 0}));
    CutStage::Input in = kInput;
    in.fewest = 1; // every node is a photon
    const auto cut = nodesOf(*scene, *mapOf(*scene, photons), in);
    ASSERT_EQ(cut.size(), photons.size());
    uint32_t low = 0;
    for (const gpu::CutNode& node : cut)
    {
        const double half_way = 0.5 * (kLow + kSlope * (node.center.x + kHalf)),
                     most = gpu::kProbeHeight * node.support;
        const double step = most / gpu::kCutEyeSteps; // rounded to one; 1e-5: of the ray's origin
        EXPECT_NEAR(eyeHeight(node), std::min(half_way, most),
                    std::max(0.501, half_way < step ? 1.0 : 0.0) * step + 1e-5);
        low += half_way < most;
        EXPECT_NEAR(dot(unpackedCutNormal(node), {0, 1, 0}), 1, 1e-6);
    }
    fmt::print("  {} of {} nodes below a ceiling that is near\n", low, cut.size());
    EXPECT_GT(low, 100u);
    EXPECT_LT(low, 900u);
}

TEST_F(CutsProbed, PackNormalsWithinTwelveBits)
{
    SceneBuilder builder;
    builder.floor(2, 0, builder.material(lambert(0.5)));
    const auto scene = load(builder.compile());
    Random random(37);
    std::vector<gpu::Photon> photons;
    for (const double x : {-1.0, -1e-4, 0.0, 1e-4, 1.0}) // axes, diagonals, and the fold of the octahedron
        for (const double y : {-1.0, -1e-4, 0.0, 1e-4, 1.0})
            for (const double z : {-1.0, -1e-4, 1e-4, 1.0})
                photons.push_back(photonAt(random.inBox({-1, 0, -1}, {1, 0, 1}), normalized({x, y, z})));
    while (photons.size() < 2000)
        photons.push_back(photonAt(random.inBox({-1, 0, -1}, {1, 0, 1}), random.direction()));
    const auto map = mapOf(*scene, photons);
    CutStage::Input in = kInput;
    in.fewest = 1; // every node is a photon
    in.probes = in.rim_probes = 0;
    const auto cut = nodesOf(*scene, *map, in);
    ASSERT_EQ(cut.size(), photons.size());
    std::map<std::pair<float, float>, Double3> normals;
    for (const gpu::Photon& photon : map->photons)
        normals[{photon.position.x, photon.position.z}] = unpackedNormal(photon.normal);
    // Half a step of each coordinate moves (x, y, 1 - |x| - |y|), which is 1 / sqrt(3) long at least, by sqrt(6) of
    // that at most.
    const double bound = std::sqrt(18) * 0.5 / ((1 << (gpu::kCutNormalBits - 1)) - 1);
    double farthest = 0;
    for (const gpu::CutNode& node : cut)
    {
        EXPECT_EQ(eyeHeight(node), 0);
        EXPECT_FALSE(isClear(node));
        farthest = std::max(farthest, length(unpackedCutNormal(node) - normals.at({node.center.x, node.center.z})));
    }
    fmt::print("  off by {:.2g} radians at most, bound {:.2g}\n", farthest, bound);
    EXPECT_LE(farthest, bound);
    EXPECT_GE(farthest, bound / 10); // they are packed
}
} // namespace
