#include "runtime/stages/interpolate.h"

namespace
{
// Neighbouring pixels a thread. Software Vulkan pays for every load, and shares them; a GPU has threads to spare.
constexpr uint32_t kCpuRun = 4;
} // namespace

InterpolateStage::InterpolateStage(const Device& device, uint32_t max_samples)
    : reorder_(device.kernel("interpolate/reorder")), run_(device.isCpu() ? kCpuRun : 1),
      apply_(device.kernel("interpolate/apply", {{"kRun", run_}})), tree_(device, "interpolate.tree", max_samples),
      sorted_(device.texelArray<gpu::SampleTexels>("interpolate.sorted", max_samples)),
      statistics_(device.array<gpu::InterpolateStatistics>("interpolate.statistics", 1))
{
}

InterpolateStage::Sorted InterpolateStage::sort(Recorder& rec, const SamplesStage::Output& samples) const
{
    tree_.record(rec, samples.spheres, samples.size);
    rec.runIndirect(
        reorder_, samples.size, NoParams{},
        {{"Size", samples.size}, {"Order", tree_.order()}, {"Samples", samples.samples}, {"Sorted", sorted_}});
    return {.size = samples.size, .tree = tree_, .samples = sorted_};
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
             {"Statistics", statistics_}});
}
