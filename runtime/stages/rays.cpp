#include "runtime/stages/rays.h"

RayQueue::RayQueue(const Device& device, std::string_view name, uint32_t capacity)
    : size(device.array<gpu::QueueSize>(fmt::format("{}.size", name), 1)),
      rays(device.array<gpu::Ray>(fmt::format("{}.rays", name), capacity))
{
}

uint32_t traceSeed(uint32_t seed, uint32_t sample, uint32_t depth)
{
    uint32_t mixed = seed;
    for (const uint32_t value : {sample, depth})
        mixed = (mixed ^ value) * 0x9e3779b1u + 0x7f4a7c15u;
    return mixed;
}

RayStage::RayStage(const Device& device, const SceneGpu& scene)
    : closest_(device.kernel("rays/closest", scene.constants())),
      visible_(device.kernel("rays/visible", scene.constants())),
      dispatch_size_(device.kernel("rays/dispatch_size")),
      set_size_(device.kernel("rays/set_size"))
{
}

void RayStage::resize(Recorder& rec, const Buffer& size, uint32_t count) const
{
    rec.run(set_size_, 1, gpu::QueueParams{.count = count}, {{"Queue", size}});
}

void RayStage::close(Recorder& rec, const Buffer& size) const
{
    rec.run(dispatch_size_, 1, NoParams{}, {{"Queue", size}});
}

void RayStage::closest(Recorder& rec, const RayQueue& queue, const Buffer& hits, uint32_t seed) const
{
    rec.runIndirect(closest_, queue.size, 0, gpu::RaysParams{.seed = seed},
                    {{"Queue", queue.size}, {"Rays", queue.rays}, {"Hits", hits}});
}

void RayStage::visible(Recorder& rec, const Buffer& size, const Buffer& shadow_rays, const Buffer& radiance) const
{
    rec.runIndirect(visible_, size, 0, NoParams{}, {{"Queue", size}, {"ShadowRays", shadow_rays}, {"Radiance", radiance}});
}
