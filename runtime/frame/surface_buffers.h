// What the pixels of a frame see.
#pragma once
#include "runtime/gpu/gpu.h"
#include "shaders/primary/primary.h"

struct SurfaceBuffers
{
    const Buffer& points;         // gpu::ShadingPoint[pixel_count]
    const Buffer& diffuse_points; // gpu::DiffusePoint[pixel_count], with a texel view
};
