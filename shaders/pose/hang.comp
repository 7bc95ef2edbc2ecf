#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/pose/pose.h"

// Hangs moving objects into the tree above them, each in a place of its own; refit.comp then fits the boxes. One thread per
// object.

layout(local_size_x = kPoseGroupSize) in;
layout(push_constant, scalar) uniform Params { PoseParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Objects { PosedObject objects[]; };
layout(set = 1, binding = 1, scalar) writeonly buffer Nodes { BvhNode nodes[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Parents { uint parents[]; }; // of moving nodes: where they hang

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.object_count)
        return;
    PosedObject object = objects[i];
    nodes[object.link / kBvhWidth].child[object.link % kBvhWidth] = object.node;
    parents[object.node - params.first_node] = object.link;
}
