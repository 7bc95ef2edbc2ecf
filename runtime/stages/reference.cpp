#include "runtime/stages/reference.h"

ReferenceStage::ReferenceStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels, uint32_t max_batch)
    : generate_(device.kernel("primary/generate")), shade_(device.kernel("reference/shade", scene.constants())),
      queue_(device, "reference.queue", max_pixels * max_batch),
      next_queue_(device, "reference.next_queue", max_pixels * max_batch),
      hits_(device.array<gpu::Hit>("reference.hits", max_pixels * max_batch)),
      states_(device.array<gpu::PathState>("reference.states", max_pixels * max_batch)),
      radiance_(device.array<gpu::vec3>("reference.radiance", max_pixels * max_batch)),
      shadow_size_(device.array<gpu::QueueSize>("reference.shadow_size", 1)),
      shadow_rays_(device.texelArray<gpu::ShadowRay>("reference.shadow_rays", max_pixels * max_batch))
{
}

namespace
{
struct Counted
{
    uint32_t stages, lobes; // as in ShadeParams
};

Counted countedFor(uint32_t term)
{
    constexpr uint32_t kEye = 1u << gpu::kStageEye, kLeft = 1u << gpu::kStageLeft;
    constexpr uint32_t kSpecular = 1u << gpu::kStageSpecular, kDeep = 1u << gpu::kStageDeep;
    switch (term)
    {
    case gpu::kTermEmission:
        return {.stages = kEye, .lobes = gpu::kLobesBoth};
    case gpu::kTermDirect:
        return {.stages = kLeft, .lobes = gpu::kLobesBoth};
    case gpu::kTermCaustics:
        return {.stages = kSpecular, .lobes = gpu::kLobeDiffuse};
    case gpu::kTermIndirect:
        return {.stages = kDeep, .lobes = gpu::kLobeDiffuse};
    case gpu::kTermGlossy:
        return {.stages = kSpecular | kDeep, .lobes = gpu::kLobeSpecular};
    default:
        check(term == gpu::kTermAll, "term {} is unknown", term);
    }
    return {.stages = kEye | kLeft | kSpecular | kDeep, .lobes = gpu::kLobesBoth};
}
} // namespace

const Buffer& ReferenceStage::record(Recorder& rec, const RayStage& rays, const Input& in) const
{
    const auto scope = rec.scope("reference");
    const uint32_t pixel_count = in.camera.width * in.camera.height;
    const uint32_t path_count = pixel_count * in.camera.sample_count;
    rays.resize(rec, queue_.size, path_count);
    rec.run(generate_, path_count, in.camera, {{"Rays", queue_.rays}});
    const Counted counted = countedFor(in.term);
    follow(rec, rays, queue_,
           {.depth = 0,
            .depth_limit = in.depth_limit,
            .pixel_count = pixel_count,
            .first_sample = in.camera.first_sample,
            .seed = in.camera.seed,
            .stages = in.emission ? counted.stages : counted.stages & ~(1u << gpu::kStageEye),
            .lobes = counted.lobes,
            .first_stage = gpu::kStageEye});
    return radiance_;
}

const Buffer& ReferenceStage::recordLeft(Recorder& rec, const RayStage& rays, const LeftInput& in) const
{
    const auto scope = rec.scope("reference");
    // The lobe of x has been chosen: everything that was left through it counts.
    follow(rec, rays, in.rays,
           {.depth = 0,
            .depth_limit = in.depth_limit,
            .pixel_count = in.path_count,
            .first_sample = 0,
            .seed = in.seed,
            .stages = countedFor(gpu::kTermIndirect).stages,
            .lobes = gpu::kLobesBoth,
            .first_stage = gpu::kStageLeft});
    return radiance_;
}

void ReferenceStage::follow(Recorder& rec, const RayStage& rays, const RayQueue& first, gpu::ShadeParams params) const
{
    const RayQueue* queue = &first;
    const RayQueue* next = &next_queue_;
    for (; params.depth < params.depth_limit; ++params.depth)
    {
        {
            const auto trace = rec.scope("reference.closest");
            rays.closest(rec, *queue, hits_, traceSeed(params.seed, params.first_sample, params.depth));
        }
        rays.reset(rec, next->size);
        rays.reset(rec, shadow_size_);
        {
            const auto shade = rec.scope("reference.shade");
            rec.runIndirect(shade_, queue->size, params,
                            {{"Queue", queue->size},
                             {"Rays", queue->rays},
                             {"Hits", hits_},
                             {"States", states_},
                             {"Radiance", radiance_},
                             {"NextQueue", next->size},
                             {"NextRays", next->rays},
                             {"ShadowQueue", shadow_size_},
                             {"ShadowRays", shadow_rays_}});
        }
        rays.close(rec, next->size);
        rays.close(rec, shadow_size_);
        const auto visible = rec.scope("reference.visible");
        rays.visible(rec, shadow_size_, shadow_rays_, radiance_);
        std::swap(queue, next);
    }
}
