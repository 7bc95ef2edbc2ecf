#include "runtime/stages/gather.h"

GatherStage::GatherStage(const Device& device, const SceneGpu& scene, uint32_t max_samples, uint32_t rays_per_sample,
                         uint32_t max_rays_per_sample, const Scratch& scratch)
    : max_samples_(max_samples), pixel_rays_(max_samples * rays_per_sample),
      has_specular_(scene.hasFeature(gpu::kFeatureSpecular)), generate_(device.kernel("gather/generate")),
      generate_pixels_(device.kernel("gather/generate_pixels", scene.transportConstants())),
      shade_(device.kernel("gather/shade", scene.transportConstants())),
      shade_knn_(device.kernel("gather/shade_knn", scene.transportConstants())), sum_(device.kernel("gather/sum")),
      add_(device.kernel("gather/add")), project_(device.kernel("gather/project", scene.transportConstants())),
      queue_(device, "gather.queue", max_samples * max_rays_per_sample, scratch),
      hits_(device.texelArray<gpu::Hit>("gather.hits", uint64_t(max_samples) * max_rays_per_sample, scratch)),
      states_(device.array<gpu::GatherState>("gather.states", uint64_t(max_samples) * max_rays_per_sample, scratch)),
      gathered_(device.array<gpu::Gathered>("gather.gathered", uint64_t(max_samples) * max_rays_per_sample, scratch)),
      directions_(device.array<uint32_t>("gather.directions", uint64_t(max_samples) * max_rays_per_sample, scratch)),
      no_legs_(device.texelArray<gpu::Leg>("gather.no_legs", gpu::kLegCount)),
      harmonics_(device.texelArray<gpu::SampleHarmonics>("gather.harmonics", scene.reflectsRoughly() ? max_samples : 1))
{
}

void GatherStage::traceFirstHits(Recorder& rec, const RayStage& rays, const SamplesStage::Output& samples,
                                 const gpu::GatherParams& params, const LegsStage* legs, GuideStage* guide) const
{
    rec.run(generate_, max_samples_ * gpu::kRaysGroupSize, params,
            {{"Size", samples.size},
             {"Samples", samples.samples},
             {"Queue", queue_.size},
             {"Rays", queue_.rays},
             {"States", states_},
             {"Legs", legs ? legs->legs() : no_legs_},
             {"Directions", directions_}});
    rays.closest(rec, queue_, hits_, traceSeed(params.seed, 0, 0));
    if (guide)
        guide->splat(rec, queue_, max_samples_ * params.ray_count, hits_);
}

void GatherStage::traceFirstHits(Recorder& rec, const RayStage& rays, const SamplesStage::Output& samples,
                                 const Input& in, GuideStage& guide) const
{
    traceFirstHits(rec, rays, samples, gpu::GatherParams{.ray_count = in.ray_count, .seed = in.seed}, nullptr, &guide);
}

void GatherStage::record(Recorder& rec, const RayStage& rays, const SamplesStage::Output& samples,
                         const PhotonTreeStage::Output& map, const CutStage::Output& cut, const Input& in,
                         GuideStage* guide) const
{
    const gpu::GatherParams params = paramsOf(in);
    traceFirstHits(rec, rays, samples, params, in.legs, guide);
    shade(rec, map, cut, params);
    rec.run(sum_, max_samples_ * gpu::kRaysGroupSize, params,
            {{"Size", samples.size}, {"GatheredBlock", gathered_}, {"Samples", samples.samples}});
    if (!in.by_direction)
        return;
    rec.run(
        project_, max_samples_ * gpu::kRaysGroupSize, params,
        {{"Size", samples.size}, {"GatheredBlock", gathered_}, {"Harmonics", harmonics_}, {"Directions", directions_}});
}

void GatherStage::recordPixels(Recorder& rec, const RayStage& rays, const PhotonTreeStage::Output& map,
                               const CutStage::Output& cut, const Input& in, const PixelInput& pixels,
                               GuideStage* guide) const
{
    gpu::GatherParams params = paramsOf(in);
    params.ray_count = raysPerPixel(pixels.point_count);
    const uint32_t band = pixel_rays_ / params.ray_count; // pixels whose rays there is room for
    for (uint32_t first = 0; first < pixels.point_count; first += band)
    {
        const gpu::PixelGatherParams here{.first_point = first,
                                          .point_count = std::min(band, pixels.point_count - first),
                                          .ray_count = params.ray_count,
                                          .first_ray = pixels.frame * params.ray_count,
                                          .seed = pixels.seed};
        params.seed = traceSeed(in.seed, first, 0);
        rays.resize(rec, queue_.size, here.point_count * here.ray_count);
        rec.run(generate_pixels_, here.point_count, here,
                {{"Points", pixels.points}, {"Rays", queue_.rays}, {"States", states_}});
        rays.closest(rec, queue_, hits_, params.seed);
        if (guide)
            guide->splat(rec, queue_, pixel_rays_, hits_, first > 0);
        shade(rec, map, cut, params);
        rec.run(add_, here.point_count, here, {{"GatheredBlock", gathered_}, {"Radiance", pixels.radiance}});
    }
}

gpu::GatherParams GatherStage::paramsOf(const Input& in) const
{
    return {.ray_count = in.ray_count,
            .seed = in.seed,
            .depth_limit = has_specular_ ? in.specular_depth : 0,
            .mode = uint32_t(in.mode),
            .photon_count = in.photon_count,
            .radius = in.radius,
            .leg_count = in.legs ? gpu::kLegCount : 0};
}

void GatherStage::shade(Recorder& rec, const PhotonTreeStage::Output& map, const CutStage::Output& cut,
                        const gpu::GatherParams& params) const
{
    const auto scope = rec.scope("gather.shade"); // the lookups: what the cut is there for
    if (CutMode(params.mode) == CutMode::kKnn)
        rec.runIndirect(shade_knn_, queue_.size, params,
                        {{"Queue", queue_.size},
                         {"Rays", queue_.rays},
                         {"Hits", hits_},
                         {"States", states_},
                         {"GatheredBlock", gathered_},
                         {"Size", map.size},
                         {"TreeNodes", map.tree.nodes()},
                         {"Photons", map.photons}});
    else
        rec.runIndirect(shade_, queue_.size, params,
                        {{"Queue", queue_.size},
                         {"Rays", queue_.rays},
                         {"Hits", hits_},
                         {"States", states_},
                         {"GatheredBlock", gathered_},
                         {"CutSize", cut.size},
                         {"TreeNodes", cut.tree.nodes()},
                         {"CutNodes", cut.nodes},
                         {"Directions", cut.directions}});
}
