#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/cut/cut.h"
#include "shaders/lib/trace.glsl"
#include "shaders/lib/climb.glsl"

// The coarse cut, bottom-up: a node is divided if a node below it is, if E~ is meaningless (its photons face apart, lie on different
// planes or on different sides of a wall), or if their density is not uniform. The undivided children of divided nodes are the cut:
// every photon has exactly one of its ancestors, or itself, in it. Algorithm 3 divides where both children are brighter than E_min:
// that makes small nodes wherever it is bright, however uniform, and nodes as large as walls in a dim room beside a bright one.
// One thread per photon.

layout(local_size_x = kCutGroupSize) in;
layout(push_constant, scalar) uniform Params { CutParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 2) uniform usamplerBuffer Photons;
layout(set = 1, binding = 3, scalar) readonly buffer LeafParents { uint leaf_parents[]; };
layout(set = 1, binding = 4, scalar) readonly buffer NodeParents { uint node_parents[]; };
layout(set = 1, binding = 5, scalar) readonly buffer Sums { PhotonSums sums[]; };
layout(set = 1, binding = 6, scalar) coherent buffer Divided { uint divided[]; }; // by inner node, 0 before
layout(set = 1, binding = 7, scalar) coherent buffer Arrivals { uint arrivals[]; }; // 0 before
layout(set = 1, binding = 8, scalar) writeonly buffer Ids { QueueSize ids; };       // of all nodes, 0 before
#include "shaders/lib/photon_node.glsl"

bool isDivided(uint child) { return (child & kTreeLeafBit) == 0u && divided[child] != 0u; }

/// Whether the halves of a node are mutually occluded: it holds photons of two rooms.
bool isWalled(PhotonNode node, uint left, uint right)
{
    vec3 a = photonNode(childId(left)).center, b = photonNode(childId(right)).center;
    vec3 lift = node.normal * (kProbeHeight * max(node.longest, 0.5 * length(b - a)));
    float distance = length(b - a);
    bool met_translucent;
    return distance > 0.0 && meetsOpaque(a + lift, (b - a) / distance, distance, met_translucent);
}

bool shouldDivide(uint node)
{
    uint left = loadTreeNode(node).left, right = loadTreeNode(node).right;
    if (isDivided(left) || isDivided(right))
        return true;
    PhotonNode n = photonNode(node);
    if (!n.flat_)
        return true;
    uint most = params.mode == kCutLeaves ? fewestPhotons(params) : max(kCutMost * params.photon_count, fewestPhotons(params));
    if (n.count > most || (n.count > fewestPhotons(params) && isUneven(node, n, params.difference)))
        return true;
    return isWalled(n, left, right);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count)
        return;
    if (i == 0u)
        ids = queueSize(2u * size.count - 1u);
    if (size.count < 2u)
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
