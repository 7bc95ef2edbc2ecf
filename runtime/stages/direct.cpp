#include "runtime/stages/direct.h"

DirectStage::DirectStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels)
    : sample_(device.kernel("direct/sample", scene.constants())),
      emitted_(device.kernel("direct/emitted", scene.constants())),
      emitter_queue_(device, "direct.emitter_queue", max_pixels),
      shadow_size_(device.array<gpu::QueueSize>("direct.shadow_size", 1)),
      shadow_rays_(device.array<gpu::ShadowRay>("direct.shadow_rays", max_pixels)),
      emitter_rays_(device.array<gpu::EmitterRay>("direct.emitter_rays", max_pixels)),
      hits_(device.texelArray<gpu::Hit>("direct.hits", max_pixels)),
      has_area_lights_(scene.hasAreaLights())
{
}

void DirectStage::record(Recorder& rec, const RayStage& rays, const Input& in) const
{
    const auto scope = rec.scope("direct");
    for (uint32_t i = 0; i < in.light_sample_count; ++i)
    {
        const gpu::DirectParams params{.point_count = in.point_count,
                                       .first_sample = in.first_sample,
                                       .seed = in.seed,
                                       .light_sample = i,
                                       .light_sample_count = in.light_sample_count};
        const gpu::RaysParams trace{traceSeed(in.seed, in.first_sample * in.light_sample_count + i, ~0u)};
        rays.reset(rec, shadow_size_);
        rays.reset(rec, emitter_queue_.size);
        rec.run(sample_, in.point_count, params,
                {{"Points", in.points}, {"ShadowQueue", shadow_size_}, {"ShadowRays", shadow_rays_},
                 {"EmitterQueue", emitter_queue_.size}, {"Rays", emitter_queue_.rays}, {"EmitterRays", emitter_rays_}});
        rays.close(rec, shadow_size_);
        rays.visible(rec, shadow_size_, shadow_rays_, in.radiance);
        if (!has_area_lights_)
            continue;
        rays.close(rec, emitter_queue_.size);
        rays.closest(rec, emitter_queue_, hits_, trace.seed);
        rec.runIndirect(emitted_, emitter_queue_.size, 0, trace,
                        {{"EmitterQueue", emitter_queue_.size}, {"Rays", emitter_queue_.rays}, {"Hits", hits_},
                         {"EmitterRays", emitter_rays_}, {"Radiance", in.radiance}});
    }
}
