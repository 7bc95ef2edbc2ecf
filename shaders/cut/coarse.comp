#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/cut/cut.h"
#include "shaders/lib/climb.glsl"

// The coarse cut, bottom-up: a node is divided where both its children are candidates (E~ > E_min), where something below
// it is, and where E~ would mean nothing. What is not divided, but below a divided node, is the cut: every photon then has
// exactly one of its ancestors, or itself, in it (Algorithm 3, first half). One thread per photon.

layout(local_size_x = kCutGroupSize) in;
layout(push_constant, scalar) uniform Params { CutParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 2) uniform usamplerBuffer Photons;
layout(set = 1, binding = 3, scalar) readonly buffer LeafParents { uint leaf_parents[]; };
layout(set = 1, binding = 4, scalar) readonly buffer NodeParents { uint node_parents[]; };
layout(set = 1, binding = 5, scalar) readonly buffer Sums { PhotonSums sums[]; };
layout(set = 1, binding = 6, scalar) readonly buffer Threshold { CutThreshold threshold; };
layout(set = 1, binding = 7, scalar) coherent buffer Divided { uint divided[]; }; // by inner node, 0 before
layout(set = 1, binding = 8, scalar) coherent buffer Arrivals { uint arrivals[]; }; // 0 before
#include "shaders/lib/photon_node.glsl"

bool isCandidate(uint child)
{
    if ((child & kTreeLeafBit) != 0u)
        return false;
    PhotonNode node = photonNode(child);
    return node.count >= fewestPhotons(params) && node.irradiance > threshold.irradiance;
}

bool isDivided(uint child) { return (child & kTreeLeafBit) == 0u && divided[child] != 0u; }

bool shouldDivide(uint node)
{
    uint left = loadTreeNode(node).left, right = loadTreeNode(node).right;
    if (isDivided(left) || isDivided(right))
        return true;
    PhotonNode n = photonNode(node);
    if (params.mode == kCutLeaves)
        return n.count > fewestPhotons(params) || !n.flat_;
    if (!n.flat_)
        return n.count > fewestPhotons(params);
    return isCandidate(left) && isCandidate(right);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count || size.count < 2u)
        return;
    uint link = leaf_parents[i];
    while (true)
    {
        uint node = link & ~kTreeLeafBit;
        fence();
        if (atomicAdd(arrivals[node], 1u) == 0u)
            return;
        fence();
        divided[node] = uint(shouldDivide(node));
        if (node == 0u)
            return;
        link = node_parents[node];
    }
}
