#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/resolve/resolve.h"

// Adds the samples of one pass to each pixel's sum, with Kahan's compensation so that any number of samples can be
// added in 32 bits. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { AccumulateParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Radiance { vec3 radiance[]; };
layout(set = 1, binding = 1, scalar) buffer Sum { vec3 sum[]; };
layout(set = 1, binding = 2, scalar) buffer Compensation { vec3 compensation[]; };
layout(set = 1, binding = 3, scalar) buffer NonFinite { uint non_finite_count; };

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.pixel_count)
        return;
    precise vec3 total = sum[pixel];
    precise vec3 lost = compensation[pixel];
    for (uint i = 0u; i < params.sample_count; ++i)
    {
        vec3 light = radiance[i * params.pixel_count + pixel];
        if (any(isnan(light)) || any(isinf(light)))
        {
            atomicAdd(non_finite_count, 1u); // counted and reported: one bad sample must not blacken a pixel for good
            continue;
        }
        precise vec3 y = light - lost;
        precise vec3 t = total + y;
        lost = (t - total) - y;
        total = t;
    }
    sum[pixel] = total;
    compensation[pixel] = lost;
}
