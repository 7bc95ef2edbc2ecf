#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/tile.glsl"
#include "shaders/lib/trace.glsl"
#include "shaders/lib/view.glsl"
#include "shaders/primary/primary.h"

// Finds what the camera ray of each pixel meets first, tile by tile. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ChainParams params; };

layout(set = 1, binding = 0, scalar) writeonly buffer Hits { Hit hits[]; };

void main()
{
    uint thread = gl_GlobalInvocationID.x;
    uint pixel_count = params.camera.width * params.camera.height;
    if (thread >= pixel_count)
        return;
    uint pixel = tiledPixel(thread, params.camera.width, pixel_count);
    Ray ray = pixelRay(params.camera, pixel, 0u);
    uint row = quotient(pixel, params.camera.width);
    AlphaSeed seed = AlphaSeed(params.trace_seed, ivec2(pixel - row * params.camera.width, row));
    hits[thread] = closestHit(ray.origin, ray.direction, kRayStart, ray.t_max, seed);
}
