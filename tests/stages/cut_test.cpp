// The illumination cut against one made by recursion over the photon tree, its irradiance against brute force.
#include "runtime/stages/gather.h"
#include "tests/stages/gi_test.h"
#include "tests/stages/ray_test.h"

#include <map>
#include <numbers>

namespace
{
/// A node of the photon tree by id: inner node i is i, photon i of n is n - 1 + i.
struct Node
{
    uint32_t first, end;  // photons
    uint32_t left, right; // ids
    Double3 center, normal, extent;
    double irradiance = 0; // luminance of E~
    bool flat_ = true;
    uint32_t count() const { return end - first; }
};

std::vector<Node> nodesOf(const PhotonMap& map)
{
    const uint32_t count = uint32_t(map.photons.size());
    const auto idOf = [&](uint32_t child)
    { return (child & gpu::kTreeLeafBit) != 0 ? (child & ~gpu::kTreeLeafBit) + count - 1 : child; };
    std::vector<Node> nodes;
    for (const gpu::TreeNode& n : map.tree.nodes)
        nodes.push_back({.first = n.first,
                         .end = n.first + n.count,
                         .left = idOf(n.left),
                         .right = idOf(n.right),
                         .center = {},
                         .normal = {},
                         .extent = {}});
    for (uint32_t i = 0; i < count; ++i)
        nodes.push_back({.first = i,
                         .end = i + 1,
                         .left = 0,
                         .right = 0,
                         .center = map.photons[i].position,
                         .normal = unpackedNormal(map.photons[i].normal),
                         .extent = {}});
    for (uint32_t id = 0; id + 1 < count; ++id)
    {
        Node& node = nodes[id];
        Double3 normal, position, low(kFar, kFar, kFar), high(-kFar, -kFar, -kFar);
        double weight = 0;
        for (uint32_t i = node.first; i < node.end; ++i)
        {
            const gpu::Photon& photon = map.photons[i];
            const double w = luminanceOf(photon.power);
            weight += w;
            normal = normal + w * unpackedNormal(photon.normal);
            position = position + w * Double3(photon.position);
            low = min(low, photon.position);
            high = max(high, photon.position);
        }
        node.center = (1 / weight) * position;
        node.normal = normalized(normal);
        node.extent = high - low;
        const Double3 n{std::abs(node.normal.x), std::abs(node.normal.y), std::abs(node.normal.z)}, e = node.extent;
        const double strewn = (node.count() + 1.0) /
                              (node.count() - 1.0); // each way: a box of so many photons is smaller than their place
        node.irradiance =
            weight / (std::max(n.x * e.y * e.z + n.y * e.x * e.z + n.z * e.x * e.y, 1e-20) * strewn * strewn);
        node.flat_ = length(normal) > 0.8 * weight && dot(n, e) < 0.5 * largest(e);
    }
    return nodes;
}

/// Algorithm 3, first half: which inner nodes the coarse cut divides.
struct CoarseCut
{
    const std::vector<Node>& nodes;
    bool leaves;          // the finest cut instead
    double threshold = 0; // E_min
    std::vector<bool> divided = std::vector<bool>(nodes.size());

    bool isCandidate(uint32_t id) const
    {
        return nodes[id].count() > 1 && nodes[id].count() >= gpu::kCutFewest && nodes[id].irradiance > threshold;
    }
    void sumLevel(uint32_t id, uint32_t level_count, double& sum, uint32_t& count) const
    {
        if (nodes[id].count() == 1)
            return;
        if (nodes[id].count() <= level_count)
        {
            sum += nodes[id].irradiance;
            ++count;
            return;
        }
        sumLevel(nodes[id].left, level_count, sum, count);
        sumLevel(nodes[id].right, level_count, sum, count);
    }
    bool divide(uint32_t id)
    {
        const Node& node = nodes[id];
        if (node.count() == 1)
            return false;
        const bool left = divide(node.left), right = divide(node.right);
        divided[id] = left || right ||
                      (leaves       ? node.count() > gpu::kCutFewest || !node.flat_
                       : node.flat_ ? isCandidate(node.left) && isCandidate(node.right)
                                    : node.count() > gpu::kCutFewest);
        return divided[id];
    }
    void run(uint32_t photon_count)
    {
        double sum = 0;
        uint32_t count = 0;
        sumLevel(0, std::max(photon_count / gpu::kCutLevelNodes, gpu::kCutFewest), sum, count);
        threshold = sum / std::max(count, 1u);
        divide(0);
    }
};

class Cuts : public GiTest
{
protected:
    static constexpr uint32_t kNearest = 50;
    static constexpr CutStage::Input kRefined{.mode = CutMode::kRefined,
                                              .iterations = 4,
                                              .difference = 0.2f,
                                              .photon_count = kNearest,
                                              .radius = 0.4f,
                                              .shrink = 1,
                                              .probes = 0,
                                              .seed = 0};

    void SetUp() override
    {
        GiTest::SetUp();
        builder_.box({-1, 0, -1}, {1, 1.5f, 1}, builder_.material(lambert(0.7)), true);
        builder_.box({-0.5f, 0, -0.4f}, {0, 0.6f, 0.1f}, builder_.material(lambert(0.5)));
        builder_.sphere({0.4f, 0.4f, 0}, 0.3f, 12, true, builder_.material(lambert(0.8)));
        builder_.light({{"type", "point"}, {"intensity", 1}, {"color", {1, 0.8, 0.5}}},
                       {{"translation", {-0.3, 1.2, 0.5}}});
        scene_ = load(builder_.compile());
    }

    std::unique_ptr<PhotonMap> roomMap(uint32_t paths)
    {
        return mapOf(*scene_,
                     emit(*scene_, PhotonKind::kGlobal,
                          {.path_count = paths, .bounce_limit = 3, .specular_depth = 0, .first_path = 0, .seed = 5}));
    }

    std::vector<gpu::CutNode> cutOf(const PhotonMap& map, const CutStage::Input& in)
    {
        const CutStage stage(device(), *scene_, std::max(uint32_t(map.photons.size()), 1u));
        std::optional<CutStage::Output> out;
        submit(*scene_, [&](Recorder& rec) { (void)stage.record(rec, map.rays, *map.gpu, in); });
        submit(*scene_, [&](Recorder& rec)
               { out.emplace(stage.record(rec, map.rays, *map.gpu, in)); }); // again: nothing left over
        return contents<gpu::CutNode>(out->nodes, countOf(out->size));
    }

    /// The ids of the cut's nodes: the one node of the photon tree with this centre.
    static std::vector<uint32_t> idsOf(const std::vector<gpu::CutNode>& cut, const std::vector<Node>& nodes)
    {
        std::vector<uint32_t> ids;
        for (const gpu::CutNode& c : cut)
        {
            uint32_t best = 0;
            double nearest = 1e30;
            for (uint32_t id = 0; id < nodes.size(); ++id)
                if (const double d2 = length2(Double3(c.center) - nodes[id].center); d2 < nearest)
                    nearest = d2, best = id;
            EXPECT_LT(nearest, 1e-10) << "a centre 10 micrometres from every node's";
            EXPECT_GT(dot(nodes[best].normal, unpackedNormal(c.normal)), 0.9999);
            ids.push_back(best);
        }
        std::ranges::sort(ids);
        return ids;
    }

    static void expectCoversEveryPhotonOnce(const std::vector<uint32_t>& ids, const std::vector<Node>& nodes,
                                            size_t photon_count)
    {
        std::vector<uint32_t> covered(photon_count);
        for (const uint32_t id : ids)
            for (uint32_t i = nodes[id].first; i < nodes[id].end; ++i)
                ++covered[i];
        EXPECT_EQ(covered, std::vector<uint32_t>(photon_count, 1));
    }

    SceneBuilder builder_;
    std::unique_ptr<SceneGpu> scene_;
};

TEST_F(Cuts, CoverEveryPhotonOnceInEveryMode)
{
    const auto map = roomMap(2000);
    const std::vector<Node> nodes = nodesOf(*map);
    for (const CutMode mode : {CutMode::kNearest, CutMode::kLeaves, CutMode::kRefined})
        for (const uint32_t iterations : {0u, 1u, 4u})
        {
            SCOPED_TRACE(fmt::format("mode {}, {} iterations", uint32_t(mode), iterations));
            CutStage::Input in = kRefined;
            in.mode = mode;
            in.iterations = iterations;
            const auto cut = cutOf(*map, in);
            fmt::print("  mode {}, {} iterations: {} nodes over {} photons\n", uint32_t(mode), iterations, cut.size(),
                       map->photons.size());
            EXPECT_LT(cut.size(), map->photons.size());
            expectCoversEveryPhotonOnce(idsOf(cut, nodes), nodes, map->photons.size());
        }
}

TEST_F(Cuts, CoverAnyNumberOfPhotons)
{
    const auto room = roomMap(200);
    for (const uint32_t count : {0u, 1u, 2u, 3u, 7u, 8u, 9u, 17u, 100u})
    {
        SCOPED_TRACE(count);
        const auto map = mapOf(*scene_, {room->photons.begin(), room->photons.begin() + count});
        const auto cut = cutOf(*map, kRefined);
        expectCoversEveryPhotonOnce(idsOf(cut, nodesOf(*map)), nodesOf(*map), count);
    }
}

TEST_F(Cuts, StandEqualPhotons)
{
    const gpu::Photon photon{.position = {0.1f, 0, 0.2f},
                             .direction = packedNormal({0, -1, 0}),
                             .power = {1, 1, 1},
                             .normal = packedNormal({0, 1, 0})};
    const auto map = mapOf(*scene_, std::vector(100, photon));
    for (const gpu::CutNode& node : cutOf(*map, kRefined))
    {
        EXPECT_NEAR(node.center.x, 0.1, 1e-6);
        EXPECT_TRUE(std::isfinite(node.irradiance.x) && std::isfinite(node.support));
    }
}

/// Each of a node's photons speaks for it as often as it has power.
TEST_F(Cuts, TellTheDirectionOfOnePhotonByPower)
{
    constexpr uint32_t kPhotons = 6, kCuts = 600;
    std::vector<gpu::Photon> photons; // so near one another that they are one node
    for (uint32_t i = 0; i < kPhotons; ++i)
        photons.push_back({.position = {0.1f + 1e-3f * float(i), 0, 0.2f},
                           .direction = packedNormal(normalized({0.1 * i, -1, 0})),
                           .power = {float(i), 0.5f * float(i), 0},
                           .normal = packedNormal({0, 1, 0})});
    const auto map = mapOf(*scene_, photons);
    const CutStage stage(device(), *scene_, kPhotons);
    std::map<uint32_t, uint32_t> times;
    for (uint32_t seed = 0; seed < kCuts; ++seed)
    {
        CutStage::Input in = kRefined;
        in.seed = seed;
        std::optional<CutStage::Output> out;
        submit(*scene_, [&](Recorder& rec) { out.emplace(stage.record(rec, map->rays, *map->gpu, in)); });
        ASSERT_EQ(countOf(out->size), 1u);
        ++times[contents<uint32_t>(out->directions, 1)[0]];
    }
    for (uint32_t i = 0; i < kPhotons; ++i)
    {
        const double share = 2.0 * i / (kPhotons * (kPhotons - 1)), deviation = std::sqrt(kCuts * share * (1 - share));
        EXPECT_NEAR(times[photons[i].direction], kCuts * share, 4 * deviation) << i;
    }
}

TEST_F(Cuts, StartWithTheCoarseCutOfAlgorithm3)
{
    const auto map = roomMap(4000);
    const std::vector<Node> nodes = nodesOf(*map);
    for (const CutMode mode : {CutMode::kRefined, CutMode::kLeaves})
    {
        CoarseCut coarse{.nodes = nodes, .leaves = mode == CutMode::kLeaves};
        coarse.run(uint32_t(map->photons.size()));
        std::vector<uint32_t> expected;
        const std::function<void(uint32_t)> list = [&](uint32_t id)
        {
            if (!coarse.divided[id])
                return expected.push_back(id);
            list(nodes[id].left);
            list(nodes[id].right);
        };
        list(0);
        std::ranges::sort(expected);
        CutStage::Input in = kRefined;
        in.mode = mode;
        in.iterations = 0;
        const auto ids = idsOf(cutOf(*map, in), nodes);
        fmt::print("  {} nodes, E_min {:.4g} W/m^2\n", expected.size(), coarse.threshold);
        EXPECT_EQ(ids, expected);
    }
}

TEST_F(Cuts, HoldTheDensityEstimateOfEveryNodesCentre)
{
    const auto map = roomMap(3000);
    CutStage::Input nearest = kRefined;
    nearest.mode = CutMode::kNearest; // the only one that reads E_p itself
    const auto cut = cutOf(*map, nearest);
    double sum = 0, difference = 0, rise = 0;
    for (const gpu::CutNode& node : cut)
    {
        const DensityBounds bounds = densityBounds(map->photons, node.center, unpackedNormal(node.normal),
                                                   kRefined.photon_count, kRefined.radius);
        const double slack =
            1e-3 * luminanceOf(bounds.most) + 1e-6; // rounding, and photons at the rim of the normal test
        const std::tuple<double, double, double> channels[]{{node.irradiance.x, bounds.least.x, bounds.most.x},
                                                            {node.irradiance.y, bounds.least.y, bounds.most.y},
                                                            {node.irradiance.z, bounds.least.z, bounds.most.z}};
        for (const auto& [got, least, most] : channels)
        {
            EXPECT_GE(got, least - slack);
            EXPECT_LE(got, most + slack);
        }
        const double exact = bounds.exact;
        sum += exact;
        difference += std::abs(luminanceOf(node.irradiance) - exact);
        rise += luminanceOf(node.irradiance) - exact;
    }
    fmt::print("  {} nodes: mean difference from the exact k-th distance {:.2f} %, bias {:+.2f} %\n", cut.size(),
               100 * difference / sum, 100 * rise / sum);
}

TEST_F(Cuts, SpreadThePowerOfAllPhotonsAndNoMore)
{
    const auto map = roomMap(3000);
    const std::vector<Node> nodes = nodesOf(*map);
    for (const CutMode mode : {CutMode::kLeaves, CutMode::kRefined})
    {
        CutStage::Input in = kRefined;
        in.mode = mode;
        Double3 spread, emitted;
        for (const gpu::CutNode& node : cutOf(*map, in)) // the integral of 1 - (d / support)^2 over a plane
            spread = spread + 0.5 * std::numbers::pi * node.support * node.support * Double3(node.irradiance);
        for (const gpu::Photon& photon : map->photons)
            emitted = emitted + Double3(photon.power);
        fmt::print("  mode {}: {:.6g} W of {:.6g} W\n", uint32_t(mode), spread.x, emitted.x);
        EXPECT_NEAR(spread.x, emitted.x, 1e-4 * emitted.x); // rounding of thousands of summands
        EXPECT_NEAR(spread.y, emitted.y, 1e-4 * emitted.y);
        EXPECT_NEAR(spread.z, emitted.z, 1e-4 * emitted.z);
    }
}

TEST_F(Cuts, ReachAsFarAsDensityEstimationWould)
{
    const auto map = roomMap(3000);
    const std::vector<Node> nodes = nodesOf(*map);
    std::map<uint32_t, uint32_t> parents;
    for (uint32_t id = 0; id + 1 < map->photons.size(); ++id)
        parents[nodes[id].left] = parents[nodes[id].right] = id;
    CutStage::Input in = kRefined;
    in.mode = CutMode::kLeaves;
    const auto cut = cutOf(*map, in);
    in.shrink = 0.25f;
    const auto shrunk = cutOf(*map, in);
    std::map<std::tuple<float, float, float>, float> shrunk_supports;
    for (const gpu::CutNode& node : shrunk)
        shrunk_supports[{node.center.x, node.center.y, node.center.z}] = node.support;
    for (const gpu::CutNode& node : cut)
    {
        uint32_t id = idsOf({node}, nodes)[0];
        while (nodes[id].count() <= gpu::kCutFewest)
            id = parents.at(id);
        const Node& above = nodes[id];
        // Photons of that node a square metre, from its E~ and their power.
        double weight = 0;
        for (uint32_t i = above.first; i < above.end; ++i)
            weight += luminanceOf(map->photons[i].power);
        const double area = weight / above.irradiance;
        const double even = std::sqrt(area * kNearest / above.count() / std::numbers::pi);
        EXPECT_NEAR(node.support, gpu::kCutSpread * std::min(even, double(in.radius)), 1e-3 * node.support);
        EXPECT_NEAR(shrunk_supports.at({node.center.x, node.center.y, node.center.z}), 0.25 * node.support,
                    1e-5 * node.support);
    }
}

TEST_F(Cuts, RefineWhereEstimatesDisagreeAndNowhereElse)
{
    const auto map = roomMap(4000);
    const std::vector<Node> nodes = nodesOf(*map);
    CoarseCut coarse{.nodes = nodes, .leaves = false};
    coarse.run(uint32_t(map->photons.size()));
    std::map<uint32_t, uint32_t> parents;
    for (uint32_t id = 0; id + 1 < map->photons.size(); ++id)
        parents[nodes[id].left] = parents[nodes[id].right] = id;
    CutStage::Input in = kRefined;
    in.iterations = 40; // no node is left over
    const auto isSmall = [&](uint32_t id) { return nodes[id].count() < 2 * gpu::kCutFewest; };
    // Whether the node's estimate may agree with E~, and whether it must, given what the histogram leaves open.
    const auto agreement = [&](uint32_t id) -> std::pair<bool, bool>
    {
        const Node& node = nodes[id];
        const DensityBounds bounds = densityBounds(map->photons, node.center, node.normal, in.photon_count, in.radius);
        const auto agrees = [&](double e, double slack) {
            return node.flat_ &&
                   std::abs(e - node.irradiance) <= (in.difference + slack) * std::max(e, node.irradiance);
        };
        const double least = luminanceOf(bounds.least), most = luminanceOf(bounds.most);
        constexpr double kSlack = 0.003; // rounding of the estimate, and photons at the rim of the normal test
        const bool may = agrees(least, kSlack) || agrees(most, kSlack) ||
                         (node.flat_ && least <= node.irradiance && node.irradiance <= most);
        return {may, agrees(least, -kSlack) && agrees(most, -kSlack)};
    };
    uint32_t agreed = 0, split = 0;
    for (const uint32_t id : idsOf(cutOf(*map, in), nodes))
    {
        if (!isSmall(id))
        {
            EXPECT_TRUE(agreement(id).first)
                << "node of " << nodes[id].count() << " photons is final though its estimate is wrong";
            ++agreed;
        }
        if (id == 0 || coarse.divided[parents[id]])
            continue;
        EXPECT_FALSE(isSmall(parents[id]));
        EXPECT_FALSE(agreement(parents[id]).second)
            << "node of " << nodes[parents[id]].count() << " photons was divided though it agrees";
        ++split;
    }
    fmt::print("  {} large final nodes, {} made by refinement\n", agreed, split);
    EXPECT_GT(agreed, 10u);
    EXPECT_GT(split, 10u);
}

TEST_F(Cuts, AreReadNearlyAsDensityIsEstimated)
{
    const auto map = roomMap(8000);
    Random random(41);
    std::vector<gpu::Sample> samples;
    for (int i = 0; i < 100; ++i)
        samples.push_back({.position = {random.between(-0.9f, 0.9f), 0, random.between(0.2f, 0.9f)},
                           .normal = packedNormal({0, 1, 0}),
                           .irradiance = {},
                           .support = 0.1f,
                           .harmonic = 0,
                           .pixel = 0});
    const uint32_t count = uint32_t(samples.size());
    constexpr uint32_t kRays = 64;
    const Buffer size = sizeBuffer(count), on_gpu = upload("test.samples", samples), spheres, kept = sizeBuffer(0);
    const CutStage stage(device(), *scene_, uint32_t(map->photons.size()));
    const GatherStage gather(device(), *scene_, count, kRays);
    const auto gathered = [&](CutMode mode)
    {
        CutStage::Input in = kRefined;
        in.mode = mode;
        submit(*scene_,
               [&](Recorder& rec)
               {
                   const auto cut = stage.record(rec, map->rays, *map->gpu, in);
                   gather.record(rec, map->rays,
                                 {.size = size, .samples = on_gpu, .spheres = spheres, .kept = kept, .kept_from = kept},
                                 *map->gpu, cut,
                                 {.mode = mode,
                                  .ray_count = kRays,
                                  .specular_depth = 0,
                                  .photon_count = kNearest,
                                  .radius = in.radius,
                                  .seed = 1});
               });
        return contents<gpu::Sample>(on_gpu, count);
    };
    const auto knn = gathered(CutMode::kKnn);
    for (const CutMode mode : {CutMode::kNearest, CutMode::kLeaves, CutMode::kRefined})
    {
        double sum = 0, difference = 0, rise = 0;
        const auto read = gathered(mode);
        for (uint32_t i = 0; i < count; ++i)
        {
            const double got = luminanceOf(read[i].irradiance), want = luminanceOf(knn[i].irradiance);
            sum += want;
            difference += std::abs(got - want);
            rise += got - want;
        }
        fmt::print(
            "  mode {}: irradiance of samples differs from full density estimation by {:.2f} %, mean {:+.2f} %\n",
            uint32_t(mode), 100 * difference / sum, 100 * rise / sum);
        EXPECT_LT(difference, kRefined.difference * sum); // what refinement lets pass at every single node
    }
}

TEST_F(Cuts, GoToTheFinestNodesWhereNoDifferenceIsLetPass)
{
    const auto map = roomMap(2000);
    const std::vector<Node> nodes = nodesOf(*map);
    CutStage::Input in = kRefined;
    in.difference = 0;
    in.iterations = 40;
    const auto ids = idsOf(cutOf(*map, in), nodes);
    for (const uint32_t id : ids)
        EXPECT_LT(nodes[id].count(), 2 * gpu::kCutFewest);
    expectCoversEveryPhotonOnce(ids, nodes, map->photons.size());
}
} // namespace
