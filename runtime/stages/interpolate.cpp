#include "runtime/stages/interpolate.h"

#include <array>

namespace
{
std::array<uint32_t, 3> constants(const SceneGpu& scene, bool glossy)
{
    return {scene.constants()[0], scene.constants()[1], glossy};
}
} // namespace

InterpolateStage::InterpolateStage(const Device& device, const SceneGpu& scene, uint32_t max_samples)
    : reorder_(device.kernel("interpolate/reorder")), apply_(device.kernel("interpolate/apply", constants(scene, false))),
      apply_glossy_(device.kernel("interpolate/apply", constants(scene, true))),
      tree_(device, "interpolate.tree", max_samples), sorted_(device.array<gpu::Sample>("interpolate.sorted", max_samples)),
      statistics_(device.array<gpu::InterpolateStatistics>("interpolate.statistics", 1)),
      unused_(device.array<uint32_t>("interpolate.unused", 1))
{
}

void InterpolateStage::record(Recorder& rec, const SamplesStage::Output& samples, const Input& in) const
{
    tree_.record(rec, samples.spheres, samples.size);
    rec.runIndirect(reorder_, samples.size, 0, NoParams{},
                    {{"Size", samples.size}, {"Order", tree_.order()}, {"Samples", samples.samples}, {"Sorted", sorted_}});
    rec.clear(statistics_);
    const gpu::InterpolateParams params{
        .point_count = in.point_count, .alpha = in.alpha, .radius = in.radius, .white = in.white, .diffuse = in.diffuse};
    const Glossy glossy = in.glossy != nullptr ? *in.glossy : Glossy{.harmonics = unused_, .lobes = unused_, .shares = unused_};
    rec.run(in.glossy != nullptr ? apply_glossy_ : apply_, in.point_count, params,
            {{"Size", samples.size}, {"TreeNodes", tree_.nodes()}, {"Samples", sorted_}, {"Points", in.points}, {"Radiance", in.radiance},
             {"Statistics", statistics_}, {"Order", tree_.order()}, {"Harmonics", glossy.harmonics}, {"Lobes", glossy.lobes},
             {"Shares", glossy.shares}});
}
