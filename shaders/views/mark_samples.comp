#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/views/views.h"

// A dot at the pixel of every irradiance sample. One thread per sample.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { ViewParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Samples { Sample samples[]; };
layout(set = 1, binding = 2, scalar) buffer Marks { uint marks[]; }; // by pixel, 0 before: 1 + index of the sample

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count)
        return;
    ivec2 picture = ivec2(params.width, params.height);
    ivec2 center = ivec2(samples[i].pixel % params.width, samples[i].pixel / params.width);
    int side = max(1, picture.y / 135);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
        {
            ivec2 at = center + ivec2(x, y) - side / 2;
            if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, picture)))
                atomicMax(marks[at.y * picture.x + at.x], i + 1u);
        }
}
