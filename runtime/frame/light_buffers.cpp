#include "runtime/frame/light_buffers.h"

LightBuffers::LightBuffers(const Device& device, uint32_t pixel_count)
    : emission(device.array<gpu::vec3>("light.emission", pixel_count)),
      sharp_direct(device.array<gpu::vec3>("light.sharp_direct", pixel_count)),
      direct(device.array<gpu::vec3>("light.direct", pixel_count)),
      indirect(device.array<gpu::vec3>("light.indirect", pixel_count)),
      glossy(device.array<gpu::vec3>("light.glossy", pixel_count)),
      caustics(device.array<gpu::vec3>("light.caustics", pixel_count))
{
}

void LightBuffers::clear(Recorder& rec) const
{
    for (const Buffer* light : all())
        rec.clear(*light);
}
