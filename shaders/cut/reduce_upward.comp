#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/cut/cut.h"
#include "shaders/lib/climb.glsl"

// Sums of power, normal and position of every inner node, bottom-up: the thread that arrives second at a node continues with
// it. One thread per photon.

layout(local_size_x = kCutGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 2) uniform usamplerBuffer Photons;
layout(set = 1, binding = 3, scalar) readonly buffer LeafParents { uint leaf_parents[]; };
layout(set = 1, binding = 4, scalar) readonly buffer NodeParents { uint node_parents[]; };
layout(set = 1, binding = 5, scalar) coherent buffer Sums { PhotonSums sums[]; };
layout(set = 1, binding = 6, scalar) coherent buffer Arrivals { uint arrivals[]; }; // 0 before
#include "shaders/lib/photon_node.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count || size.count < 2u)
        return;
    PhotonSums total = photonSums(i);
    uint count = 1u; // photons of total
    uint link = leaf_parents[i];
    while (true)
    {
        uint node = link & ~kTreeLeafBit;
        fence();
        if (atomicAdd(arrivals[node], 1u) == 0u)
            return;
        fence();
        uint sibling = (link & kTreeLeafBit) != 0u ? loadTreeNode(node).left : loadTreeNode(node).right;
        uint index = sibling & ~kTreeLeafBit;
        bool leaf = (sibling & kTreeLeafBit) != 0u;
        PhotonSums other;
        if (leaf)
            other = photonSums(index);
        else
            other = sums[index];
        uint other_count = leaf ? 1u : loadTreeNode(index).count;
        // The left child first: equal bits in any order of arrival.
        if ((link & kTreeLeafBit) != 0u)
            total = joined(other, other_count, total, count);
        else
            total = joined(total, count, other, other_count);
        count += other_count;
        sums[node] = total;
        if (node == 0u)
            return;
        link = node_parents[node];
    }
}
