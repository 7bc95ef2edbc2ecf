#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/gather/gather.h"

// Adds the results of its own rays to every pixel of a band. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { PixelGatherParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer GatheredBlock { Gathered gathered[]; };
layout(set = 1, binding = 1, scalar) buffer Radiance { vec3 radiance[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.point_count)
        return;
    vec3 sum = vec3(0.0);
    for (uint k = i * params.ray_count; k < (i + 1u) * params.ray_count; ++k)
        sum += gathered[k].radiance;
    radiance[params.first_point + i] += sum / float(params.ray_count);
}
