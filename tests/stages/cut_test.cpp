// The illumination cut against one made by recursion over the photon tree, its irradiance against brute force.
#include "format/package_read.h"
#include "runtime/stages/gather.h"
#include "tests/stages/cut_twin.h"
#include "tests/stages/ray_test.h"

#include <numbers>

namespace
{
class Cuts : public GiTest
{
protected:
    static constexpr uint32_t kNearest = 50;
    static constexpr uint32_t kMostPhotons = 20000;
    static constexpr float kReach = 0.125f; // of the scene's diagonal
    static constexpr CutStage::Input kRefined{.mode = CutMode::kRefined,
                                              .iterations = 4,
                                              .difference = 0.2f,
                                              .photon_count = kNearest,
                                              .radius = kReach,
                                              .shrink = 1,
                                              .probes = 0,
                                              .seed = 0};

    void SetUp() override
    {
        GiTest::SetUp();
        builder_.box({-1, 0, -1}, {1, 1.5f, 1}, builder_.material(lambert(0.7)), true);
        builder_.box({-0.5f, 0, -0.4f}, {0, 0.6f, 0.1f}, builder_.material(lambert(0.5)));
        builder_.sphere({0.4f, 0.4f, 0}, 0.3f, 8, true, builder_.material(lambert(0.8)));
        builder_.quad({0.3f, 0, -0.9f}, {0, 0.9f, 0}, {0, 0, 0.5f},
                      builder_.material(lambert(0.5))); // a wall of one sheet
        builder_.light({{"type", "point"}, {"intensity", 1}, {"color", {1, 0.8, 0.5}}},
                       {{"translation", {-0.3, 1.2, 0.5}}});
        path_ = builder_.compile();
        scene_ = load(path_);
    }

    std::unique_ptr<PhotonMap> roomMap(uint32_t paths)
    {
        return mapOf(*scene_, emit(*scene_, PhotonKind::kGlobal,
                                   {.path_count = paths, .first_path = 0, .seed = 5, .bounce_limit = 3}));
    }

    std::vector<gpu::CutNode> cutOf(const PhotonMap& map, const CutStage::Input& in)
    {
        EXPECT_LE(map.photons.size(), kMostPhotons);
        if (!stage_)
            stage_.emplace(device(), *scene_, kMostPhotons);
        std::optional<CutStage::Output> out;
        submit(*scene_, [&](Recorder& rec) { (void)stage_->record(rec, map.rays, *map.gpu, in); });
        submit(*scene_, [&](Recorder& rec)
               { out.emplace(stage_->record(rec, map.rays, *map.gpu, in)); }); // again: nothing left over
        return contents<gpu::CutNode>(out->nodes, countOf(out->size));
    }

    /// How far density estimates reach, metres: no picture is drawn.
    double reach() const { return kReach * diagonalOf(*scene_); }

    SceneBuilder builder_;
    std::filesystem::path path_;
    std::unique_ptr<SceneGpu> scene_;
    std::optional<CutStage> stage_;
};

TEST_F(Cuts, CoverEveryPhotonOnceInEveryMode)
{
    const auto map = roomMap(2000);
    const std::vector<TwinNode> nodes = twinNodesOf(*map);
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
        expectCoversEveryPhotonOnce(idsOf(cut, twinNodesOf(*map)), twinNodesOf(*map), count);
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

/// A node's direction is that of one of its photons, chosen with probability proportional to its power.
TEST_F(Cuts, TellTheDirectionOfOnePhotonByPower)
{
    constexpr uint32_t kPhotons = 6, kCuts = 100;
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

/// Divided are the nodes above those of the cut: each for its own sake, or because one below it is.
TEST_F(Cuts, DivideWhereANodeWouldMeanNothingAndNowhereElse)
{
    const auto map = roomMap(4000);
    const std::vector<TwinNode> nodes = twinNodesOf(*map);
    const auto parents = parentsOf(nodes);
    const auto package = package::Package::open(path_);
    ASSERT_TRUE(package);
    for (const CutMode mode : {CutMode::kRefined, CutMode::kLeaves})
    {
        SCOPED_TRACE(uint32_t(mode));
        CutStage::Input in = kRefined;
        in.mode = mode;
        in.iterations = 0;
        in.photon_count = 400; // so that not many nodes are divided for their size alone
        const CutRules rules{.nodes = nodes,
                             .triangles = package->bvhTriangles(),
                             .leaves = mode == CutMode::kLeaves,
                             .difference = in.difference,
                             .photon_count = in.photon_count};
        std::vector<bool> divided(nodes.size());
        for (uint32_t id : idsOf(cutOf(*map, in), nodes))
            while (id != 0)
                divided[id = parents.at(id)] = true;
        uint32_t uneven = 0, bent = 0, walled = 0, open = 0;
        for (uint32_t id = 0; id + 1 < map->photons.size(); ++id)
        {
            if (divided[nodes[id].left] || divided[nodes[id].right])
            {
                EXPECT_TRUE(divided[id]);
                continue;
            }
            if (!divided[id] && nodes[id].count() < gpu::kCutFewest && id % 8 != 0)
                continue; // there are many of them, and rays are slow here
            const Verdict wanted = rules.isDivided(id);
            EXPECT_NE(wanted, divided[id] ? Verdict::kNo : Verdict::kYes) << nodes[id].count() << " photons";
            open += wanted == Verdict::kOpen;
            if (!divided[id])
                continue;
            bent += nodes[id].flat == Verdict::kNo;
            uneven += nodes[id].count() > gpu::kCutFewest && rules.isUneven(id) == Verdict::kYes;
            walled += nodes[id].flat == Verdict::kYes && rules.isWalled(id) == Verdict::kYes;
        }
        fmt::print("  of {} nodes: {} bent, {} uneven, {} walled, {} left open by rounding\n", nodes.size(), bent,
                   uneven, walled, open);
        EXPECT_GT(bent, 5u);
        EXPECT_GT(walled, 0u);
        EXPECT_TRUE(uneven > 5 || rules.leaves);
        EXPECT_LT(open, nodes.size() / 100);
    }
}

TEST_F(Cuts, HoldTheDensityEstimateOfEveryNodesCentre)
{
    const auto map = roomMap(3000);
    const std::vector<TwinNode> nodes = twinNodesOf(*map);
    CutStage::Input nearest = kRefined;
    nearest.mode = CutMode::kNearest; // the only one that reads E_p itself
    const auto cut = cutOf(*map, nearest);
    double sum = 0, difference = 0, rise = 0;
    const auto ids = idsOf(cut, nodes);
    for (size_t i = 0; i < cut.size(); ++i)
    {
        const gpu::CutNode& node = cut[i];
        const DensityBounds bounds =
            densityBounds(map->photons, node.center, nodes[ids[i]].normal, kRefined.photon_count, reach());
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
    const std::vector<TwinNode> nodes = twinNodesOf(*map);
    const auto parents = parentsOf(nodes);
    for (const CutMode mode : {CutMode::kLeaves, CutMode::kRefined})
    {
        CutStage::Input in = kRefined;
        in.mode = mode;
        const auto cut = cutOf(*map, in);
        in.shrink = 0.25f;
        std::map<std::tuple<float, float, float>, float> shrunk;
        for (const gpu::CutNode& node : cutOf(*map, in))
            shrunk[{node.center.x, node.center.y, node.center.z}] = node.support;
        const auto ids = idsOf(cut, nodes);
        uint32_t capped = 0;
        for (size_t i = 0; i < cut.size(); ++i)
        {
            const TwinNode& node = nodes[ids[i]];
            Range even = evenRadius(nodes, parents, ids[i], kNearest, reach());
            capped += even.most == reach();
            if (mode == CutMode::kRefined && node.count() > gpu::kCutFewest)
                even = {std::max(node.longest, even.least), std::max(node.longest, even.most)};
            constexpr double kSlack = 1e-4; // rounding, relative
            EXPECT_GE(cut[i].support, (1 - kSlack) * gpu::kCutSpread * even.least);
            EXPECT_LE(cut[i].support, (1 + kSlack) * gpu::kCutSpread * even.most);
            EXPECT_NEAR(shrunk.at({cut[i].center.x, cut[i].center.y, cut[i].center.z}), 0.25 * cut[i].support,
                        1e-5 * cut[i].support);
        }
        EXPECT_LT(capped, cut.size() / 2); // or the test would show nothing
    }
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
                           .harmonic_mean_distance = 0,
                           .pixel = 0});
    const uint32_t count = uint32_t(samples.size());
    constexpr uint32_t kRays = 64;
    const Buffer size = sizeBuffer(count), on_gpu = upload("test.samples", samples), spheres;
    const CutStage stage(device(), *scene_, uint32_t(map->photons.size()));
    const GatherStage gather(device(), *scene_, count, kRays, kRays);
    const auto gathered = [&](CutMode mode)
    {
        CutStage::Input in = kRefined;
        in.mode = mode;
        submit(*scene_,
               [&](Recorder& rec)
               {
                   const auto cut = stage.record(rec, map->rays, *map->gpu, in);
                   gather.record(rec, map->rays, {.size = size, .samples = on_gpu, .spheres = spheres}, *map->gpu, cut,
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
} // namespace
