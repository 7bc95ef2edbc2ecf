#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/cut/cut.h"

// The nodes of the cut in the order of their tree. One thread per node.

layout(local_size_x = kCutGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Ids { uint ids[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Order { uint order[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Finals { CutNode finals[]; };
layout(set = 1, binding = 4, scalar) readonly buffer Directions { uint directions[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer Nodes { CutNode nodes[]; };
layout(set = 1, binding = 6, scalar) writeonly buffer NodeDirections { uint node_directions[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count)
        return;
    nodes[i] = finals[ids[order[i]]];
    node_directions[i] = directions[order[i]];
}
