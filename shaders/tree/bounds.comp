#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/climb.glsl"
#include "shaders/rays/rays.h"
#include "shaders/tree/tree.h"

// Bounds of all nodes, bottom-up: the thread that arrives second at a node continues with it, so that no thread waits.
// One thread per sphere.

layout(local_size_x = kTreeGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Spheres { vec4 spheres[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Order { uint order[]; };
layout(set = 1, binding = 3, scalar) readonly buffer LeafParents { uint leaf_parents[]; };
layout(set = 1, binding = 4, scalar) readonly buffer NodeParents { uint node_parents[]; };
layout(set = 1, binding = 5, scalar) coherent buffer Nodes { TreeNode nodes[]; };
layout(set = 1, binding = 6, scalar) coherent buffer Arrivals { uint arrivals[]; }; // 0 before

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count || size.count < 2u)
        return;
    vec4 sphere = spheres[order[i]];
    vec3 low = sphere.xyz - sphere.w, high = sphere.xyz + sphere.w;
    uint link = leaf_parents[i];
    while (true)
    {
        uint node = link & ~kTreeLeafBit;
        if ((link & kTreeLeafBit) == 0u)
        {
            nodes[node].left_min = low;
            nodes[node].left_max = high;
        }
        else
        {
            nodes[node].right_min = low;
            nodes[node].right_max = high;
        }
        fence();
        if (atomicAdd(arrivals[node], 1u) == 0u || node == 0u)
            return;
        fence();
        low = min(nodes[node].left_min, nodes[node].right_min);
        high = max(nodes[node].left_max, nodes[node].right_max);
        link = node_parents[node];
    }
}
