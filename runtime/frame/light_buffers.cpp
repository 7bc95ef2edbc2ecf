#include "runtime/frame/light_buffers.h"

LightBuffers::LightBuffers(const Device& device, uint32_t point_count, bool has_caustics)
    : emission(device.array<gpu::vec3>("light.emission", point_count)),
      sharp_direct(device.array<gpu::vec3>("light.sharp_direct", point_count)),
      direct(device.array<gpu::vec3>("light.direct", point_count)),
      indirect(device.array<gpu::vec3>("light.indirect", point_count)),
      glossy(device.array<gpu::vec3>("light.glossy", point_count)),
      caustics(device.array<gpu::vec3>("light.caustics", has_caustics ? point_count : 1))
{
}

void LightBuffers::clear(Recorder& rec, uint32_t terms) const
{
    const std::pair<uint32_t, const Buffer*> added[] = {{gpu::kLightSharpDirect, &sharp_direct},
                                                        {gpu::kLightDirect, &direct},
                                                        {gpu::kLightIndirect, &indirect},
                                                        {gpu::kLightGlossy, &glossy},
                                                        {gpu::kLightCaustics, &caustics}};
    for (const auto& [term, light] : added)
        if ((terms & term) != 0)
            rec.clear(*light);
}
