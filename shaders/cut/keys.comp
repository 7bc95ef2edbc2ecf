#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/cut/cut.h"
#include "shaders/lib/morton.glsl"

// Sort keys of the tree over the nodes of the cut. They need not wait for cut/sample_direction.comp, which may move a centre within
// its node: the tree's bounds are made after that. One thread per node.

layout(local_size_x = kCutGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Ids { uint ids[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Finals { CutNode finals[]; }; // by id
layout(set = 1, binding = 3, scalar) writeonly buffer Keys { uint keys[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer Order { uint order[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count)
        return;
    keys[i] = mortonCode(finals[ids[i]].center);
    order[i] = i;
}
