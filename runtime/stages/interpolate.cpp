#include "runtime/stages/interpolate.h"

namespace
{
// Neighbouring pixels a thread. Software Vulkan pays for every load, and shares them; a GPU has threads to spare.
constexpr uint32_t kCpuRun = 4;

uint32_t groupsOf(uint32_t point_count)
{
    return (point_count + gpu::kRaysGroupSize - 1) / gpu::kRaysGroupSize;
}
} // namespace

InterpolateStage::InterpolateStage(const Device& device, uint32_t max_samples, uint32_t max_points)
    : reorder_(device.kernel("interpolate/reorder")), nearby_kernel_(device.kernel("interpolate/nearby")),
      run_(device.isCpu() ? kCpuRun : 1), apply_(device.kernel("interpolate/apply", {{"kRun", run_}})),
      tree_(device, "interpolate.tree", max_samples),
      sorted_(device.texelArray<gpu::SampleTexels>("interpolate.sorted", max_samples)),
      nearby_(device.array<uint32_t>("interpolate.nearby", uint64_t(groupsOf(max_points)) * gpu::kNearbySamples)),
      nearby_counts_(device.array<uint32_t>("interpolate.nearby_counts", groupsOf(max_points))),
      statistics_(device.array<gpu::InterpolateStatistics>("interpolate.statistics", 1))
{
}

InterpolateStage::Sorted InterpolateStage::sort(Recorder& rec, const SamplesStage::Output& samples,
                                                const View& view) const
{
    tree_.record(rec, samples.spheres, samples.size);
    rec.runIndirect(
        reorder_, samples.size, NoParams{},
        {{"Size", samples.size}, {"Order", tree_.order()}, {"Samples", samples.samples}, {"Sorted", sorted_}});
    const uint32_t groups = groupsOf(view.point_count);
    if (run_ == 1 || view.by_direction) // runs of pixels search for themselves
        rec.run(nearby_kernel_, groups * gpu::kNearbyThreads,
                gpu::NearbyParams{.point_count = view.point_count, .width = view.width, .group_count = groups},
                {{"Size", samples.size},
                 {"TreeNodes", tree_.nodes()},
                 {"Samples", sorted_},
                 {"Points", view.points},
                 {"Nearby", nearby_},
                 {"NearbyCounts", nearby_counts_}});
    return {
        .size = samples.size, .tree = tree_, .samples = sorted_, .nearby = nearby_, .nearby_counts = nearby_counts_};
}

void InterpolateStage::record(Recorder& rec, const Sorted& sorted, const Input& in) const
{
    rec.clear(statistics_);
    const gpu::InterpolateParams params{
        .point_count = in.point_count, .width = in.width, .alpha = in.alpha, .white = in.white};
    rec.run(apply_, (in.point_count + run_ - 1) / run_, params,
            {{"Size", sorted.size},
             {"TreeNodes", sorted.tree.nodes()},
             {"Samples", sorted.samples},
             {"DiffusePoints", in.diffuse_points},
             {"Radiance", in.radiance},
             {"Statistics", statistics_},
             {"Nearby", sorted.nearby},
             {"NearbyCounts", sorted.nearby_counts}});
}
