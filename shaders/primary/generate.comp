#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/tile.glsl"
#include "shaders/lib/view.glsl"

// Makes the camera rays, from the near plane to the far one, tile by tile. One thread per ray.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { CameraParams params; };

layout(set = 1, binding = 0, scalar) writeonly buffer Rays { Ray rays[]; };

void main()
{
    uint thread = gl_GlobalInvocationID.x;
    uint pixel_count = params.width * params.height;
    if (thread >= pixel_count * params.sample_count)
        return;
    uint sample_ = quotient(thread, pixel_count);
    uint pixel = tiledPixel(thread - sample_ * pixel_count, params.width, pixel_count);
    rays[thread] = pixelRay(params, pixel, sample_);
}
