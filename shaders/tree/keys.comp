#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/scene.glsl"
#include "shaders/rays/rays.h"
#include "shaders/tree/tree.h"

// The Morton code of every sphere's centre within the scene's cube. One thread per sphere.

layout(local_size_x = kTreeGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Spheres { vec4 spheres[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Keys { uint keys[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer Order { uint order[]; };

uint spreadBits(uint x) // ten bits, two zeroes before each
{
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    return (x | (x << 2)) & 0x09249249u;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count)
        return;
    vec3 extent = scene.bounds_max - scene.bounds_min;
    float longest = max(extent.x, max(extent.y, extent.z));
    vec3 unit = clamp((spheres[i].xyz - scene.bounds_min) / max(longest, 1e-20), 0.0, 1.0);
    uvec3 cell = min(uvec3(unit * 1024.0), uvec3(1023u));
    keys[i] = spreadBits(cell.x) << 2 | spreadBits(cell.y) << 1 | spreadBits(cell.z);
    order[i] = i;
}
