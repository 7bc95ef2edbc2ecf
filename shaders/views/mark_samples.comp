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
    int radius = (picture.y + 150) / 300;
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x)
        {
            ivec2 at = center + ivec2(x, y);
            if (x * x + y * y <= radius * radius && all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, picture)))
                atomicMax(marks[at.y * picture.x + at.x], i + 1u);
        }
}
