// The surfaces visible in the pixels of a frame: one point each, and a second for what a smooth layer over it mirrors.
#pragma once
#include "runtime/gpu/gpu.h"
#include "shaders/primary/primary.h"

struct SurfaceBuffers
{
    const Buffer&
        points; // gpu::ShadingPoint[point_count]; the second point of a pixel lies pixel_count after the first
    const Buffer& diffuse_points; // gpu::DiffusePoint[point_count], with a texel view
    uint32_t point_count;         // pixels, or twice as many
};
