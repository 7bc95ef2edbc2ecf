// Where nodes of the illumination cut must not reach: to the other side of a sheet, to the room behind a wall, over the
// edge of a shadow.
#include "runtime/stages/gather.h"
#include "tests/stages/cut_twin.h"
#include "tests/stages/ray_test.h"

namespace
{
class CutsDivide : public CutTest
{
protected:
    static constexpr CutStage::Input kInput{.mode = CutMode::kRefined,
                                            .iterations = 4,
                                            .difference = 0.2f,
                                            .photon_count = 50,
                                            .radius = 0.1f,
                                            .shrink = 1,
                                            .probes = 0,
                                            .seed = 3};
};

TEST_F(CutsDivide, PhotonsThatFaceApart)
{
    SceneBuilder builder;
    const int white = builder.material(lambert(0.7));
    builder.box({-1, 0, -1}, {1, 1.5f, 1}, white);
    builder.sphere({1.6f, 0.6f, 0}, 0.4f, 10, false, white);
    for (const auto& [x, intensity] : {std::pair(0.0, 1.0), {1.6, 0.3}, {2.6, 8.0}, {-2.0, 2.0}}) // within and without
        builder.light({{"type", "point"}, {"intensity", intensity}}, {{"translation", {x, 0.7, 0.1}}});
    const auto scene = load(builder.compile());
    const auto map = mapOf(
        *scene, emit(*scene, PhotonKind::kGlobal, {.path_count = 4000, .first_path = 0, .seed = 5, .bounce_limit = 3}));
    uint32_t inside = 0, outside = 0; // on the box's wall at x = 1
    for (const gpu::Photon& photon : map->photons)
        if (std::abs(photon.position.x - 1) < 1e-5f)
            ++(unpackedNormal(photon.normal).x < 0 ? inside : outside);
    ASSERT_GT(inside, 50u);
    ASSERT_GT(outside, 50u);
    const std::vector<TwinNode> nodes = twinNodesOf(*map);
    for (const CutMode mode : {CutMode::kNearest, CutMode::kLeaves, CutMode::kRefined})
    {
        CutStage::Input in = kInput;
        in.mode = mode;
        const auto ids = idsOf(nodesOf(*scene, *map, in), nodes);
        expectCoversEveryPhotonOnce(ids, nodes, map->photons.size());
        double least = 1;
        for (const uint32_t id : ids)
            for (uint32_t i = nodes[id].first; i < nodes[id].end; ++i)
                least = std::min(least, dot(unpackedNormal(map->photons[i].normal), nodes[id].normal));
        fmt::print("  mode {}: {} nodes, least cosine {:.3f}\n", uint32_t(mode), ids.size(), least);
        EXPECT_GE(least, 1 - 0.3 - 1e-4); // kFacingApart, and rounding
    }
}

/// Two rooms with a wall of one sheet between them; photons on the floor, red ones in x < 0, green ones in x > 0.
class CutsAtAWall : public CutsDivide
{
protected:
    static constexpr uint32_t kPhotons = 1500; // a room
    static constexpr float kHalf = 1, kHigh = 0.8f;

    void SetUp() override
    {
        CutsDivide::SetUp();
        SceneBuilder builder;
        const int white = builder.material(lambert(0.5));
        builder.box({-kHalf, 0, -kHalf}, {kHalf, kHigh, kHalf}, white, true);
        builder.quad({0, 0, -kHalf}, {0, kHigh, 0}, {0, 0, 2 * kHalf}, white);
        scene_ = load(builder.compile());
    }

    std::unique_ptr<PhotonMap> floorMap(float red, float green)
    {
        Random random(7);
        std::vector<gpu::Photon> photons;
        for (uint32_t i = 0; i < 2 * kPhotons; ++i)
        {
            const float x = random.between(1e-3f, kHalf), z = random.between(-kHalf, kHalf);
            photons.push_back(i % 2 == 0 ? photonAt({-x, 0, z}, {0, 1, 0}, {red, 0, 0})
                                         : photonAt({x, 0, z}, {0, 1, 0}, {0, green, 0}));
        }
        return mapOf(*scene_, photons);
    }

    std::unique_ptr<SceneGpu> scene_;
};

TEST_F(CutsAtAWall, HoldPhotonsOfOneRoom)
{
    // Of equal luminance, too: then nothing but the wall divides them.
    for (const float red : {1.0f, float(0.7152 / 0.2126), 1000.0f})
    {
        const auto map = floorMap(red, 1);
        const std::vector<TwinNode> nodes = twinNodesOf(*map);
        for (const CutMode mode : {CutMode::kNearest, CutMode::kLeaves, CutMode::kRefined})
        {
            CutStage::Input in = kInput;
            in.mode = mode;
            uint32_t both = 0;
            for (const uint32_t id : idsOf(nodesOf(*scene_, *map, in), nodes))
            {
                bool red_room = false, green_room = false;
                for (uint32_t i = nodes[id].first; i < nodes[id].end; ++i)
                    (map->photons[i].position.x < 0 ? red_room : green_room) = true;
                both += red_room && green_room;
            }
            EXPECT_EQ(both, 0u) << "mode " << uint32_t(mode) << ", red " << red;
        }
    }
}

/// What a cut's nodes of the other room would give the floor in x > 0, unless lookups see that they are behind the
/// wall, and what its own give it, by a fine grid; watts of luminance.
struct FloorLight
{
    double own = 0, foreign = 0;
};

FloorLight lightOnDimFloor(const std::vector<gpu::CutNode>& cut, float half)
{
    constexpr int kSteps = 200;
    FloorLight light;
    for (const gpu::CutNode& node : cut)
    {
        const bool behind = node.center.x < 0; // and so is its eye, right above it
        if (behind && !isClear(node))
            continue; // the wall is as high as the room: every ray to the eye meets it
        double sum = 0;
        for (int i = 0; i < kSteps; ++i)
            for (int k = 0; k < kSteps; ++k)
            {
                const double x = half * (i + 0.5) / kSteps - node.center.x,
                             z = half * (2 * (k + 0.5) / kSteps - 1) - node.center.z;
                sum += std::max(0.0, 1 - (x * x + z * z) / (double(node.support) * node.support));
            }
        (behind ? light.foreign : light.own) +=
            sum * 2 * half * half / (kSteps * kSteps) * luminanceOf(node.irradiance);
    }
    return light;
}

TEST_F(CutsAtAWall, LightNothingBehindIt)
{
    constexpr float kBright = 100;
    const auto map = floorMap(kBright, 1), dim = floorMap(0, 1);
    std::vector<gpu::Sample> samples; // over the dim floor, most of them near the wall
    Random random(13);
    for (int i = 0; i < 200; ++i)
        samples.push_back({.position = {i % 2 == 0 ? random.between(0.01f, 0.1f) : random.between(0.1f, 0.9f), 0.1f,
                                        random.between(-0.9f, 0.9f)},
                           .normal = packedNormal({0, -1, 0}),
                           .irradiance = {},
                           .support = 0.1f,
                           .harmonic_mean_distance = 0,
                           .pixel = 0});
    const uint32_t count = uint32_t(samples.size()), rays = 64;
    const Buffer size = sizeBuffer(count), on_gpu = upload("test.samples", samples), spheres;
    const CutStage stage(device(), *scene_, uint32_t(map->photons.size()));
    const GatherStage gather(device(), *scene_, count, rays, rays);
    const auto gathered = [&](const PhotonMap& of, const CutStage::Input& in)
    {
        submit(*scene_,
               [&](Recorder& rec)
               {
                   const auto cut = stage.record(rec, of.rays, *of.gpu, in);
                   gather.record(rec, of.rays, {.size = size, .samples = on_gpu, .spheres = spheres}, *of.gpu, cut,
                                 {.mode = in.mode,
                                  .ray_count = rays,
                                  .specular_depth = 0,
                                  .photon_count = in.photon_count,
                                  .radius = in.radius,
                                  .seed = 1});
               });
        return contents<gpu::Sample>(on_gpu, count);
    };
    for (const CutMode mode : {CutMode::kLeaves, CutMode::kRefined})
    {
        CutStage::Input in = kInput;
        in.mode = mode;
        in.probes = 16;
        in.rim_probes = 12;
        const auto lit = gathered(*map, in);
        const FloorLight floor =
            lightOnDimFloor(contents<gpu::CutNode>(stage.output().nodes, stage.nodeCount(device())), kHalf);
        const double power = 0.7152 * kPhotons;
        const auto alone = gathered(*dim, in);
        double own = 0, foreign = 0, difference = 0, squares = 0;
        for (uint32_t i = 0; i < count; ++i)
        {
            const double d = lit[i].irradiance.y - alone[i].irradiance.y;
            own += alone[i].irradiance.y / count;
            foreign += lit[i].irradiance.x / count;
            difference += d / count;
            squares += d * d / count;
        }
        const double error = std::sqrt((squares - difference * difference) / count);
        fmt::print("  mode {}: floor {:.2f} % of its own light, {:.4f} % of the other's; samples {:.4g} W/m^2 in green "
                   "({:+.2f} % by "
                   "the other room, standard error {:.2f} %), {:.3g} in red\n",
                   uint32_t(mode), 100 * floor.own / power, 100 * floor.foreign / power, own, 100 * difference / own,
                   100 * error / own, foreign);
        EXPECT_LE(floor.foreign, 0.005 * power);
        EXPECT_LE(0.2126 * foreign, 0.005 * 0.7152 * own);
        if (mode != CutMode::kLeaves)
            continue; // so few nodes that the noise of their own probe rays exceeds that
        EXPECT_LE(std::abs(difference), 4 * error);
        EXPECT_LE(error, 0.1 * own) << "too few rays to tell";
    }
}

/// A floor in photons of equal power.
class CutsOfAFloor : public CutsDivide
{
protected:
    void SetUp() override
    {
        CutsDivide::SetUp();
        SceneBuilder builder;
        builder.floor(2, 0, builder.material(lambert(0.5)));
        scene_ = load(builder.compile());
    }

    /// @param at a photon's place from two even numbers in 0..1
    std::unique_ptr<PhotonMap> mapOfPlaces(uint32_t count, const std::function<gpu::vec3(float, float)>& at)
    {
        Random random(23);
        std::vector<gpu::Photon> photons;
        for (uint32_t i = 0; i < count; ++i)
        {
            const float u = random.unit(), v = random.unit();
            photons.push_back(photonAt(at(u, v), {0, 1, 0}, {1, 1, 1}));
        }
        return mapOf(*scene_, photons);
    }

    std::unique_ptr<SceneGpu> scene_;
};

TEST_F(CutsOfAFloor, AreCoarseWhereLightIsEven)
{
    const auto map = mapOfPlaces(4000, [](float u, float v) { return gpu::vec3{2 * u - 1, 0, 2 * v - 1}; });
    CutStage::Input in = kInput;
    const size_t refined = nodesOf(*scene_, *map, in).size();
    in.mode = CutMode::kLeaves;
    const size_t leaves = nodesOf(*scene_, *map, in).size();
    // One node of 400 with more than kCutFewest photons is taken for an uneven one (3 standard errors). Each of those
    // divides what is above it.
    const std::vector<TwinNode> nodes = twinNodesOf(*map);
    const auto parents = parentsOf(nodes);
    double large = 0;
    uint32_t depth = 0;
    for (uint32_t id = 0; id < nodes.size(); ++id)
    {
        uint32_t above = 0;
        for (uint32_t i = id; i != 0 && nodes[id].count() > gpu::kCutFewest; i = parents.at(i))
            ++above;
        large += nodes[id].count() > gpu::kCutFewest;
        depth = std::max(depth, above);
    }
    const double mistaken = large / 400;
    fmt::print("  {} nodes refined, {} leaves; {} large nodes, depth {}\n", refined, leaves, large, depth);
    EXPECT_LE(double(refined), 1 + (mistaken + 4 * std::sqrt(mistaken)) * (depth + 1));
    EXPECT_GT(leaves, 4 * refined);
    EXPECT_GE(leaves, map->photons.size() / gpu::kCutFewest);
}

TEST_F(CutsOfAFloor, EndAtTheEdgeOfAShadow)
{
    constexpr float kEdge = 0.13f, kFactor = 4;
    const float bright = kFactor * (1 + kEdge), share = bright / (bright + 1 - kEdge);
    const auto map = mapOfPlaces(8000,
                                 [&](float u, float v)
                                 {
                                     const float x = u < share ? -1 + (1 + kEdge) * u / share
                                                               : kEdge + (1 - kEdge) * (u - share) / (1 - share);
                                     return gpu::vec3{x, 0, 2 * v - 1};
                                 });
    const std::vector<TwinNode> nodes = twinNodesOf(*map);
    uint32_t large[2] = {0, 0}, across = 0;
    for (const uint32_t id : idsOf(nodesOf(*scene_, *map, kInput), nodes))
    {
        const TwinNode& node = nodes[id];
        double low = kFar, high = -kFar;
        uint32_t lit = 0;
        for (uint32_t i = node.first; i < node.end; ++i)
        {
            const double x = map->photons[i].position.x;
            low = std::min(low, x);
            high = std::max(high, x);
            lit += x < kEdge;
        }
        if (node.count() <= 4 * gpu::kCutFewest)
            continue;
        ++large[low < kEdge ? 0 : 1];
        if (lit == 0 || lit == node.count())
            continue;
        // Photons a metre of x on both sides, and the standard errors that isUneven() expects of them.
        const double dark = node.count() - lit, a = lit / (kEdge - low), b = dark / (high - kEdge);
        EXPECT_LE(std::abs(a - b), 3 * std::sqrt(a * a * 2 / lit + b * b * 2 / dark))
            << node.count() << " photons, " << lit << " lit";
        ++across;
    }
    fmt::print("  {} large nodes in the light, {} in the shadow, {} across the edge\n", large[0], large[1], across);
    EXPECT_GT(large[0], 5u);
    EXPECT_GT(large[1], 2u);
}

/// Even light on half of the floor and in a narrow strip, where density estimation of so many photons reaches over its
/// edges.
TEST_F(CutsOfAFloor, RefineWhereEstimatesDisagreeBeyondChanceAndNowhereElse)
{
    const auto map = mapOfPlaces(4000,
                                 [](float u, float v) {
                                     return gpu::vec3{u < 0.5f ? -2 * u : 0.5f + 0.04f * u, 0, 2 * v - 1};
                                 });
    const std::vector<TwinNode> nodes = twinNodesOf(*map);
    const auto parents = parentsOf(nodes);
    const double reach = kInput.radius * diagonalOf(*scene_);
    CutStage::Input in = kInput;
    in.photon_count = 300;
    in.iterations = 0;
    std::vector<bool> coarse(nodes.size());
    for (const uint32_t id : idsOf(nodesOf(*scene_, *map, in), nodes))
        coarse[id] = true;
    in.iterations = 40; // no node is left over
    const auto isSmall = [&](uint32_t id) { return nodes[id].count() < 2 * gpu::kCutFewest; };
    // By how much of the larger the estimate differs from E~ beyond what is let pass, given what the histogram leaves
    // open.
    const auto disagreement = [&](uint32_t id) -> Range
    {
        const TwinNode& node = nodes[id];
        const DensityBounds bounds = densityBounds(map->photons, node.center, node.normal, in.photon_count, reach);
        const double let_pass = std::max(double(in.difference), 3 * std::sqrt(node.noise2 + 1.2 / in.photon_count));
        const double least = luminanceOf(bounds.least), most = luminanceOf(bounds.most);
        Range off{1e300, -1e300};
        for (const double e : {least, most})
            for (const double f : {node.irradiance.least, node.irradiance.most})
            {
                const double differs = std::abs(e - f) / std::max(e, f);
                off = {std::min(off.least, differs), std::max(off.most, differs)};
            }
        if (least <= node.irradiance.most && node.irradiance.least <= most)
            off.least = 0;
        constexpr double kSlack = 0.003; // rounding of the estimate, and photons at the rim of the normal test
        return {off.least - let_pass - kSlack, off.most - let_pass + kSlack};
    };
    uint32_t agreed = 0, split = 0;
    std::vector<bool> divided(nodes.size());
    for (uint32_t id : idsOf(nodesOf(*scene_, *map, in), nodes))
    {
        if (!isSmall(id))
        {
            EXPECT_LE(disagreement(id).least, 0)
                << "node of " << nodes[id].count() << " photons is final though its estimate is wrong";
            ++agreed;
        }
        while (!coarse[id])
        {
            ASSERT_NE(id, 0u) << "a node above those of the coarse cut";
            divided[id = parents.at(id)] = true;
        }
    }
    for (uint32_t id = 0; id < nodes.size(); ++id)
        if (divided[id])
        {
            EXPECT_FALSE(isSmall(id));
            EXPECT_GE(disagreement(id).most, 0)
                << "node of " << nodes[id].count() << " photons was divided though it agrees";
            ++split;
        }
    fmt::print("  {} large final nodes, {} divided by refinement\n", agreed, split);
    EXPECT_GT(agreed, 10u);
    EXPECT_GT(split, 10u);
}
} // namespace
