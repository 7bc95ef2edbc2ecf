#include "runtime/stages/glossy.h"

#include "runtime/stages/glossy_lobe.h"

GlossyStage::GlossyStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels, const Scratch& scratch)
    : generate_(device.kernel("glossy/generate", scene.constants())),
      shade_(device.kernel("glossy/shade", scene.transportConstants())),
      harmonics_(device.kernel("glossy/harmonics", scene.constants())),
      queue_(device, "glossy.queue", max_pixels, scratch),
      hits_(device.texelArray<gpu::Hit>("glossy.hits", max_pixels, scratch)),
      states_(device.array<gpu::GatherState>("glossy.states", max_pixels, scratch)),
      lobes_(device.uploadTexels<gpu::GlossyLobe>(
          "glossy.lobes", scene.reflectsRoughly() ? glossyLobes() : std::vector<gpu::GlossyLobe>(1))),
      shares_(device.array<float>("glossy.shares", scene.reflectsRoughly() ? max_pixels : 1, scratch))
{
}

void GlossyStage::record(Recorder& rec, const RayStage& rays, const CutStage::Output& cut, const Input& in) const
{
    gpu::GlossyParams params{.point_count = in.point_count,
                             .width = in.width,
                             .first_sample = in.first_sample,
                             .seed = in.seed,
                             .depth_limit = in.specular_depth,
                             .shared_ = in.shared,
                             .roulette_threshold = in.roulette_threshold};
    rays.reset(rec, queue_.size);
    rec.run(generate_, in.point_count, params,
            {{"Points", in.points},
             {"Queue", queue_.size},
             {"Rays", queue_.rays},
             {"States", states_},
             {"Shares", shares_}});
    rays.close(rec, queue_.size);
    rays.closest(rec, queue_, hits_, traceSeed(in.seed, in.first_sample, ~0u));
    rec.runIndirect(shade_, queue_.size, params,
                    {{"Queue", queue_.size},
                     {"Rays", queue_.rays},
                     {"Hits", hits_},
                     {"States", states_},
                     {"Radiance", in.radiance},
                     {"CutSize", cut.size},
                     {"TreeNodes", cut.tree.nodes()},
                     {"CutNodes", cut.nodes},
                     {"Directions", cut.directions}});
}

void GlossyStage::recordHarmonics(Recorder& rec, const InterpolateStage::Sorted& samples, const Buffer& harmonics,
                                  const Input& in) const
{
    rec.run(harmonics_, in.point_count, gpu::GlossyParams{.point_count = in.point_count, .width = in.width},
            {{"Size", samples.size},
             {"TreeNodes", samples.tree.nodes()},
             {"Samples", samples.samples},
             {"Points", in.points},
             {"Radiance", in.radiance},
             {"Harmonics", harmonics},
             {"Lobes", lobes_},
             {"Shares", shares_},
             {"Nearby", samples.nearby},
             {"NearbyCounts", samples.nearby_counts}});
}
