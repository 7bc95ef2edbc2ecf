// Adaptive seeding and k-means against slow twins; samples are shading points of the picture.
#include "runtime/stages/samples.h"
#include "tests/stages/shading_points.h"

#include <bit>
#include <map>
#include <set>

namespace
{
constexpr uint32_t kWidth = 48, kHeight = 40;
constexpr uint32_t kLevels = 6; // 64 x 64 pixels hold the picture

double variation(double alpha, Double3 x, Double3 n, Double3 center, Double3 normal)
{
    return alpha * length(x - center) + length(n - normal);
}

/// Pixels in Z-order: the children of a node are four neighbours.
uint32_t zOrder(uint32_t x, uint32_t y)
{
    uint32_t index = 0;
    for (int bit = 15; bit >= 0; --bit)
        index = index << 2 | (y >> bit & 1) << 1 | (x >> bit & 1);
    return index;
}

struct QuadNode // of one level
{
    std::vector<uint32_t> pixels; // that take part
    double variation = 0;         // their sum of eps to the node's means
    uint32_t samples = 0;         // its budget: those that lie in it
};

struct Cluster
{
    Double3 position, normal;
};

class SamplesTest : public GiTest
{
protected:
    /// Walls, a sphere and a box before a dark background; a mirror shows what is diffuse beyond it, a black box
    /// nothing.
    void SetUp() override
    {
        GiTest::SetUp();
        builder_.floor(3, 0, builder_.material(lambert(0.7)));
        builder_.quad({-1.5f, 0, -1.5f}, {2, 0, 0}, {0, 2, 0}, builder_.material(lambert(0.5)));
        builder_.sphere({-0.4f, 0.4f, 0}, 0.4f, 16, true, builder_.material(lambert(0.6)));
        builder_.box({0.3f, 0, -0.8f}, {0.9f, 0.7f, -0.2f}, builder_.material(lambert(0.3)));
        builder_.box({0.6f, 0, 0.3f}, {0.9f, 0.3f, 0.6f}, builder_.material(lambert(0)));
        builder_.quad({-1.5f, 0, 0.9f}, {0, 0, -1.5f}, {0, 1, 0}, builder_.material(mirror(1, 1, 1)));
        const auto path = builder_.compile();
        scene_ = load(path);
        points_.emplace(device(), *scene_, path, kCamera, kWidth, kHeight);
        for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
            if (points_->points[pixel].exists && points_->points[pixel].diffuse.x > 0)
                taking_part_.push_back(pixel);
    }

    std::vector<gpu::Sample> samples(SamplesMode mode, uint32_t budget, uint32_t iterations = 3, uint32_t seed = 1)
    {
        if (!stage_)
            stage_.emplace(device(), kWidth, kHeight, kMostSamples);
        EXPECT_EQ(stage_->stride(), 1u);
        const RayStage rays(device(), *scene_);
        std::optional<SamplesStage::Output> out;
        submit(*scene_,
               [&](Recorder& rec)
               {
                   out.emplace(stage_->record(rec, rays,
                                              {.diffuse_points = points_->gpu->diffuse_points,
                                               .mode = mode,
                                               .budget = budget,
                                               .iterations = iterations,
                                               .alpha = float(alpha_ * diagonalOf(*scene_)),
                                               .reach = 5,
                                               .seed = seed}));
               });
        return contents<gpu::Sample>(out->samples, countOf(out->size));
    }

    std::vector<std::vector<QuadNode>> quadtree(const std::vector<gpu::Sample>& samples) const
    {
        std::vector<std::vector<QuadNode>> levels(kLevels + 1);
        for (uint32_t level = 0; level <= kLevels; ++level)
        {
            levels[level].resize(1u << (2 * (kLevels - level)));
            const auto nodeOf = [&](uint32_t pixel) -> QuadNode&
            { return levels[level][zOrder(pixel % kWidth, pixel / kWidth) >> (2 * level)]; };
            for (const uint32_t pixel : taking_part_)
                nodeOf(pixel).pixels.push_back(pixel);
            for (const gpu::Sample& sample : samples)
                ++nodeOf(sample.pixel).samples;
            for (QuadNode& node : levels[level])
            {
                Double3 position, normal;
                for (const uint32_t pixel : node.pixels)
                {
                    position = position + points_->points[pixel].position;
                    normal = normal + points_->points[pixel].normal;
                }
                for (const uint32_t pixel : node.pixels)
                    node.variation += std::min<double>(
                        gpu::kMostVariation,
                        variation(alpha_, points_->points[pixel].position, points_->points[pixel].normal,
                                  (1.0 / double(node.pixels.size())) * position, normalized(normal)));
            }
        }
        return levels;
    }

    /// The cluster of least variation of every pixel that takes part, and the sum of these variations.
    std::pair<std::vector<uint32_t>, double> assigned(const std::vector<Cluster>& clusters) const
    {
        std::vector<uint32_t> owners;
        double total = 0;
        for (const uint32_t pixel : taking_part_)
        {
            const ShadingPoints::Point& p = points_->points[pixel];
            uint32_t owner = 0;
            double best = 1e30;
            for (uint32_t c = 0; c < clusters.size(); ++c)
                if (const double eps =
                        variation(alpha_, p.position, p.normal, clusters[c].position, clusters[c].normal);
                    eps < best)
                    best = eps, owner = c;
            owners.push_back(owner);
            total += best;
        }
        return {owners, total};
    }

    static std::vector<Cluster> clustersOf(const std::vector<gpu::Sample>& samples)
    {
        std::vector<Cluster> clusters;
        for (const gpu::Sample& sample : samples)
            clusters.push_back({sample.position, unpackedNormal(sample.normal)});
        return clusters;
    }

    static std::set<uint32_t> pixelsOf(const std::vector<gpu::Sample>& samples)
    {
        std::set<uint32_t> pixels;
        for (const gpu::Sample& sample : samples)
            pixels.insert(sample.pixel);
        return pixels;
    }

    static constexpr uint32_t kMostSamples = 128;
    static inline const Camera kCamera{
        .name = "",
        .position = {0.4f, 1.2f, 2.4f},
        .forward = normalize({-0.15f, -0.35f, -1}),
        .up = normalize(cross(cross(gpu::vec3{-0.15f, -0.35f, -1}, gpu::vec3{0, 1, 0}), gpu::vec3{-0.15f, -0.35f, -1})),
        .vertical_fov = 0.9f,
        .orthographic_height = 0};
    double alpha_ = 5; // of Eq. 2, per metre
    SceneBuilder builder_;
    std::unique_ptr<SceneGpu> scene_;
    std::optional<ShadingPoints> points_;
    std::vector<uint32_t> taking_part_; // pixels
    std::optional<SamplesStage> stage_;
};

TEST_F(SamplesTest, AreDistinctShadingPointsOfDiffuseSurfaces)
{
    ASSERT_GT(taking_part_.size(), kWidth * kHeight / 2);
    ASSERT_LT(taking_part_.size(), kWidth * kHeight * 9 / 10); // background and black things are left out
    for (const SamplesMode mode : {SamplesMode::kUniform, SamplesMode::kSeeded, SamplesMode::kKmeans})
    {
        const auto all = samples(mode, 100);
        EXPECT_EQ(pixelsOf(all).size(), all.size()) << uint32_t(mode);
        for (const gpu::Sample& sample : all)
        {
            ASSERT_LT(sample.pixel, kWidth * kHeight);
            const ShadingPoints::Point& point = points_->points[sample.pixel];
            EXPECT_TRUE(point.exists && point.diffuse.x > 0) << sample.pixel;
            // Off the surface along the ray: by 2 x 8 x 2^-24 x (3 x 2 x 2 + 2) m at most, by a cosine of 1/64 at
            // least.
            EXPECT_LT(length(Double3(sample.position) - point.position), 9e-4);
            EXPECT_LT(length(unpackedNormal(sample.normal) - point.normal), 1e-4); // of 16-bit encodings
            EXPECT_GT(sample.support, 0);
        }
    }
}

TEST_F(SamplesTest, SpendTheirBudgetExactly)
{
    for (const SamplesMode mode : {SamplesMode::kUniform, SamplesMode::kSeeded})
        for (const uint32_t budget : {1u, 2u, 3u, 17u, 64u, 127u, 128u})
            for (const uint32_t seed : {1u, 2u})
            {
                const auto all = samples(mode, budget, 0, seed);
                EXPECT_EQ(all.size(), budget) << uint32_t(mode);
                EXPECT_EQ(pixelsOf(all).size(), budget) << uint32_t(mode);
            }
}

TEST_F(SamplesTest, AreNoMoreThanThereAreShadingPoints)
{
    // A camera at the floor's end: few pixels hit anything.
    Camera aside = kCamera;
    aside.forward = normalize({1, -0.25f, -0.3f});
    aside.up = normalize(cross(cross(aside.forward, {0, 1, 0}), aside.forward));
    SceneBuilder builder;
    builder.quad({1.2f, 0, 1.5f}, {0.5f, 0, 0}, {0, 0.5f, 0}, builder.material(lambert(0.5)));
    const auto path = builder.compile();
    const auto scene = load(path);
    const ShadingPoints few(device(), *scene, path, aside, kWidth, kHeight);
    const auto count = std::ranges::count_if(few.points, &ShadingPoints::Point::exists);
    ASSERT_GT(count, 10);
    ASSERT_LT(count, kMostSamples);
    const RayStage rays(device(), *scene);
    const SamplesStage stage(device(), kWidth, kHeight, kMostSamples);
    std::optional<SamplesStage::Output> out;
    submit(*scene,
           [&](Recorder& rec)
           {
               out.emplace(stage.record(rec, rays,
                                        {.diffuse_points = few.gpu->diffuse_points,
                                         .mode = SamplesMode::kSeeded,
                                         .budget = kMostSamples,
                                         .iterations = 0,
                                         .alpha = float(alpha_ * diagonalOf(*scene)),
                                         .reach = 5,
                                         .seed = 1}));
           });
    const auto all = contents<gpu::Sample>(out->samples, countOf(out->size));
    EXPECT_EQ(all.size(), size_t(count)); // everyone of them
    EXPECT_EQ(pixelsOf(all).size(), all.size());
}

TEST_F(SamplesTest, AreSharedOutByVariation)
{
    for (const auto& [mode, alpha] : {std::pair{SamplesMode::kUniform, 5.0},
                                      {SamplesMode::kSeeded, 0.3},
                                      {SamplesMode::kSeeded, 5.0},
                                      {SamplesMode::kSeeded, 600.0}})
    {
        alpha_ = alpha;
        uint32_t checked = 0;
        for (uint32_t seed = 1; seed <= 4; ++seed)
        {
            const auto levels = quadtree(samples(mode, kMostSamples, 0, seed));
            EXPECT_EQ(levels[kLevels][0].samples, kMostSamples);
            for (uint32_t level = 2; level <= kLevels; ++level)
                for (size_t i = 0; i < levels[level].size(); ++i)
                {
                    const std::span<const QuadNode> children(&levels[level - 1][4 * i], 4);
                    const uint32_t budget = levels[level][i].samples;
                    double variations = 0;
                    for (const QuadNode& child : children)
                        variations += child.variation;
                    const auto due = [&](const QuadNode& child)
                    {
                        const bool by_count = mode == SamplesMode::kUniform || variations == 0;
                        return budget * (by_count ? double(child.pixels.size()) /
                                                        double(std::max<size_t>(levels[level][i].pixels.size(), 1))
                                                  : child.variation / variations);
                    };
                    for (const QuadNode& child : children)
                        EXPECT_LE(child.samples, child.pixels.size());
                    // Where no child is full, each gets its due, rounded up or down; 1e-3: fixed-point sums.
                    if (std::ranges::any_of(children,
                                            [&](const QuadNode& c) { return due(c) + 1 > double(c.pixels.size()); }))
                        continue;
                    for (const QuadNode& child : children)
                        EXPECT_LT(std::abs(child.samples - due(child)), 1 + 1e-3 * budget)
                            << "level " << level << ", node " << i;
                    checked += budget > 0;
                }
        }
        fmt::print("  mode {}, alpha {} 1/m: {} nodes' splits checked\n", uint32_t(mode), alpha, checked);
        EXPECT_GT(checked, 100u);
    }
}

TEST_F(SamplesTest, AreThoseOfKMeans)
{
    for (const auto& [seed, alpha] : {std::pair{1u, 0.3}, {2u, 5.0}, {3u, 5.0}})
    {
        alpha_ = alpha;
        const auto seeds = samples(SamplesMode::kSeeded, 64, 0, seed);
        std::vector<Cluster> clusters = clustersOf(seeds);
        auto [owners, total] = assigned(clusters);
        for (uint32_t iterations = 1; iterations <= 4; ++iterations)
        {
            std::vector<Double3> positions(clusters.size()), normals(clusters.size());
            std::vector<uint32_t> counts(clusters.size());
            for (size_t i = 0; i < taking_part_.size(); ++i)
            {
                positions[owners[i]] = positions[owners[i]] + points_->points[taking_part_[i]].position;
                normals[owners[i]] = normals[owners[i]] + points_->points[taking_part_[i]].normal;
                ++counts[owners[i]];
            }
            for (size_t c = 0; c < clusters.size(); ++c)
                if (counts[c] > 0)
                    clusters[c] = {(1.0 / counts[c]) * positions[c], normalized(normals[c])};
            const double before = total;
            std::tie(owners, total) = assigned(clusters);
            std::map<uint32_t, std::pair<double, uint32_t>> nearest; // by cluster: eps, pixel
            for (size_t i = 0; i < taking_part_.size(); ++i)
            {
                const ShadingPoints::Point& p = points_->points[taking_part_[i]];
                const Cluster& c = clusters[owners[i]];
                const std::pair found{variation(alpha_, p.position, p.normal, c.position, c.normal), taking_part_[i]};
                const auto [entry, is_new] = nearest.emplace(owners[i], found);
                if (!is_new && found.first < entry->second.first)
                    entry->second = found;
            }
            // 16-bit normals and fixed-point sums let eps differ by 1e-4: of points so near each other any may be the
            // nearest.
            constexpr double kTie = 2e-4;
            const auto got = samples(SamplesMode::kKmeans, 64, iterations, seed);
            std::set<uint32_t> expected;
            uint32_t common = 0;
            for (const auto& [cluster, found] : nearest)
            {
                const auto& [least, pixel] = found;
                const Cluster& c = clusters[cluster];
                expected.insert(pixel);
                common += uint32_t(std::ranges::any_of(got,
                                                       [&, bound = least + kTie](const gpu::Sample& sample)
                                                       {
                                                           const ShadingPoints::Point& p =
                                                               points_->points[sample.pixel];
                                                           return variation(alpha_, p.position, p.normal, c.position,
                                                                            c.normal) <= bound;
                                                       }));
            }
            fmt::print("  alpha {} 1/m, seed {}, iteration {}: total eps {:.4f} -> {:.4f}; {} samples, {} of them the "
                       "twin's; eps to samples {:.4f}\n",
                       alpha, seed, iterations, before, total, got.size(), common, assigned(clustersOf(got)).second);
            EXPECT_LE(total, before);
            EXPECT_EQ(got.size(), expected.size());
            EXPECT_GE(common, got.size() - 1); // a point between two clusters that goes to the other one moves both
        }
    }
}

TEST_F(SamplesTest, MoveWithTheSeed)
{
    EXPECT_EQ(pixelsOf(samples(SamplesMode::kKmeans, 64, 3, 1)), pixelsOf(samples(SamplesMode::kKmeans, 64, 3, 1)));
    EXPECT_NE(pixelsOf(samples(SamplesMode::kKmeans, 64, 3, 1)), pixelsOf(samples(SamplesMode::kKmeans, 64, 3, 2)));
}
} // namespace
