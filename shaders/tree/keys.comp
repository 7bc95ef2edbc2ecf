#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/morton.glsl"
#include "shaders/rays/rays.h"
#include "shaders/tree/tree.h"

// The Morton code of every sphere's centre within the scene's cube. One thread per sphere.

layout(local_size_x = kTreeGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Spheres { vec4 spheres[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Keys { uint keys[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer Order { uint order[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count)
        return;
    keys[i] = mortonCode(spheres[i].xyz);
    order[i] = i;
}
