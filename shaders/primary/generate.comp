#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/random.glsl"
#include "shaders/lib/tile.glsl"
#include "shaders/lib/view.glsl"

// Makes the camera rays, each through a point of its pixel (box filter), from the near plane to the far one, tile by tile.
// One thread per ray.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { CameraParams params; };

layout(set = 1, binding = 0, scalar) writeonly buffer Rays { Ray rays[]; };

void main()
{
    uint thread = gl_GlobalInvocationID.x;
    uint pixel_count = params.width * params.height;
    if (thread >= pixel_count * params.sample_count)
        return;
    uint sample_ = quotient(thread, pixel_count), first = sample_ * pixel_count;
    uint pixel = tiledPixel(thread - first, params.width, pixel_count);
    uint row = quotient(pixel, params.width), column = pixel - row * params.width;
    Sampler s = Sampler(hash(params.seed, pixel), params.first_sample + sample_, 0u);
    vec2 within = params.jitter.x > 0.0 ? params.jitter : nextPair(s);
    rays[thread] = cameraRay(params, vec2(column, row) + within, first + pixel);
}
