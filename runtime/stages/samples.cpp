#include "runtime/stages/samples.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace
{
// Points a sample: enough that a cluster's mean is settled, and no more, for every point costs a search an iteration.
constexpr uint32_t kPointsPerSample = 24;

uint32_t strideFor(uint32_t pixel_count, uint32_t max_samples)
{
    uint32_t stride = 1;
    while (pixel_count / (4 * stride * stride) >= kPointsPerSample * max_samples)
        stride *= 2;
    return stride;
}

uint32_t levelsFor(uint32_t width, uint32_t height, uint32_t stride)
{
    const uint32_t longest = (std::max(width, height) + stride - 1) / stride;
    return std::max(1u, uint32_t(std::bit_width(longest - 1)));
}

/// Points in Z-order up to the last one within the picture: of a wide picture's square that is less than half.
uint32_t pointCount(uint32_t width, uint32_t height, uint32_t stride)
{
    const uint32_t x = (width - 1) / stride, y = (height - 1) / stride;
    uint32_t last = 0;
    for (uint32_t bit = 0; bit < 16; ++bit)
        last |= (x >> bit & 1) << (2 * bit) | (y >> bit & 1) << (2 * bit + 1);
    return last + 1;
}
} // namespace

SamplesStage::SamplesStage(const Device& device, uint32_t width, uint32_t height, uint32_t max_samples)
    : width_(width), height_(height), stride_(strideFor(width * height, max_samples)),
      levels_(levelsFor(width, height, stride_)), grid_count_(1u << (2 * levels_)),
      point_count_(pointCount(width, height, stride_)), points_kernel_(device.kernel("samples/points")),
      mean_(device.kernel("samples/mean")), variation_(device.kernel("samples/variation")),
      budget_(device.kernel("samples/budget")), seed_(device.kernel("samples/seed")),
      assign_(device.kernel("samples/assign")), update_(device.kernel("samples/update")),
      snap_(device.kernel("samples/snap")), occupied_kernel_(device.kernel("samples/occupied")),
      place_(device.kernel("samples/place")), seed_compaction_(device, "samples.seed_compaction", point_count_),
      sample_compaction_(device, "samples.compaction", max_samples), tree_(device, "samples.tree", max_samples),
      point_size_(device.array<gpu::QueueSize>("samples.point_size", 1)),
      points_(device.array<gpu::SamplePoint>("samples.points", point_count_)),
      quad_nodes_(device.array<gpu::QuadNode>("samples.quad_nodes", grid_count_ / 3 + 1)),
      budgets_(device.array<uint32_t>("samples.budgets", grid_count_ / 3 + 1)),
      seed_flags_(device.array<uint32_t>("samples.seed_flags", point_count_)),
      seeds_(device.array<uint32_t>("samples.seeds", point_count_)),
      cluster_size_(device.array<gpu::QueueSize>("samples.cluster_size", 1)),
      clusters_(device.texelArray<gpu::Cluster>("samples.clusters", max_samples)),
      cluster_spheres_(device.array<gpu::vec4>("samples.cluster_spheres", max_samples)),
      sums_(device.array<gpu::ClusterSums>("samples.sums", max_samples)),
      owners_(device.array<gpu::uvec2>("samples.owners", point_count_)),
      occupied_flags_(device.array<uint32_t>("samples.occupied_flags", max_samples)),
      occupied_(device.array<uint32_t>("samples.occupied", max_samples)),
      size_(device.array<gpu::QueueSize>("samples.size", 1)),
      samples_(device.array<gpu::Sample>("samples.samples", max_samples)),
      spheres_(device.array<gpu::vec4>("samples.spheres", max_samples))
{
}

/// Algorithm 1: as many clusters as the budget has, each at a point.
void SamplesStage::recordSeeds(Recorder& rec, const RayStage& rays, const Input& in) const
{
    // Fixed point that cannot overflow in any sum that is read, those of the root's children and below.
    gpu::SeedParams seeding{.level = 0,
                            .last_level = 0,
                            .levels = levels_,
                            .budget = in.budget,
                            .seed = in.seed,
                            .alpha = in.alpha,
                            .variation_scale = 4294967040.0f / (gpu::kMostVariation * float(grid_count_ / 4)),
                            .uniform_ = in.mode == SamplesMode::kUniform};
    // One group works on this level and on all above.
    const uint32_t group_level = std::max(levels_, gpu::kGroupLevels + 1) - gpu::kGroupLevels;
    const auto levelThreads = [&](uint32_t level) { return 1u << (2 * (levels_ - level)); };
    for (uint32_t level = 1; level <= group_level; ++level)
    {
        seeding.level = level;
        seeding.last_level = level == group_level ? levels_ : level;
        rec.run(mean_, levelThreads(level), seeding, {{"Points", points_}, {"Nodes", quad_nodes_}});
    }
    rec.run(variation_, point_count_, seeding, {{"Points", points_}, {"Nodes", quad_nodes_}});
    rec.clear(seed_flags_);
    for (uint32_t level = group_level; level >= 1; --level)
    {
        seeding.level = level == group_level ? levels_ : level;
        seeding.last_level = level;
        rec.run(budget_, levelThreads(level), seeding,
                {{"Points", points_}, {"Nodes", quad_nodes_}, {"Budgets", budgets_}, {"Seeds", seed_flags_}});
    }
    rays.resize(rec, point_size_, point_count_);
    seed_compaction_.record(rec, seed_flags_, seeds_, cluster_size_, point_size_);
    rec.runIndirect(seed_, cluster_size_, NoParams{},
                    {{"Size", cluster_size_},
                     {"Seeds", seeds_},
                     {"Points", points_},
                     {"Clusters", clusters_},
                     {"Spheres", cluster_spheres_},
                     {"Sums", sums_}});
}

void SamplesStage::assign(Recorder& rec, const gpu::ClusterParams& params) const
{
    rec.run(assign_, point_count_, params,
            {{"Size", cluster_size_},
             {"Points", points_},
             {"Clusters", clusters_},
             {"TreeNodes", tree_.nodes()},
             {"Order", tree_.order()},
             {"Sums", sums_},
             {"Owners", owners_},
             {"Seeds", seeds_}});
}

/// Algorithm 2; at its end every point of the picture has an owner.
void SamplesStage::recordClusters(Recorder& rec, const Input& in, const gpu::ClusterParams& params) const
{
    tree_.record(rec, cluster_spheres_, cluster_size_);
    for (uint32_t i = 0; in.mode == SamplesMode::kKmeans && i < in.iterations; ++i)
    {
        assign(rec, params);
        rec.runIndirect(
            update_, cluster_size_, params,
            {{"Size", cluster_size_}, {"Sums", sums_}, {"Clusters", clusters_}, {"Spheres", cluster_spheres_}});
        tree_.refit(rec, cluster_spheres_, cluster_size_);
    }
    assign(rec, params);
}

SamplesStage::Output SamplesStage::record(Recorder& rec, const RayStage& rays, const Input& in) const
{
    rec.run(points_kernel_, point_count_,
            gpu::PointParams{.width = width_, .height = height_, .stride = stride_, .seed = in.seed},
            {{"DiffusePoints", in.diffuse_points}, {"Points", points_}});
    const gpu::ClusterParams params{.point_count = point_count_,
                                    .alpha = in.alpha,
                                    .fixed_scale = 4294967040.0f / float(grid_count_),
                                    .reach = in.reach};
    recordSeeds(rec, rays, in);
    recordClusters(rec, in, params);
    rec.run(snap_, point_count_, params, {{"Owners", owners_}, {"Sums", sums_}});
    rec.runIndirect(occupied_kernel_, cluster_size_, NoParams{},
                    {{"Size", cluster_size_}, {"Sums", sums_}, {"Flags", occupied_flags_}});
    sample_compaction_.record(rec, occupied_flags_, occupied_, size_, cluster_size_);
    rec.runIndirect(place_, size_, params,
                    {{"Size", size_},
                     {"Occupied", occupied_},
                     {"Sums", sums_},
                     {"Points", points_},
                     {"Samples", samples_},
                     {"Spheres", spheres_},
                     {"Clusters", clusters_}});
    return output();
}
