#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/cut/cut.h"

// One round of refinement: the irradiance E_p at a node's centre by density estimation; where it is near E~ the node is
// final, else its children take its place (Algorithm 3, second half). A final node spreads the power of its photons over its
// support, as far as density estimation reaches there: the cut holds the power of all photons, no more and no less. (E_p of
// the nodes, weighted to a mean, would not: nodes are many where photons happen to be dense.) One thread per node of the
// working list.

layout(local_size_x = kCutGroupSize) in;
layout(push_constant, scalar) uniform Params { CutParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 2) uniform usamplerBuffer Photons;
layout(set = 1, binding = 3, scalar) readonly buffer Sums { PhotonSums sums[]; };
layout(set = 1, binding = 4, scalar) readonly buffer WorkSize { QueueSize work_size; };
layout(set = 1, binding = 5, scalar) readonly buffer Work { uint work[]; };
layout(set = 1, binding = 6, scalar) buffer NextSize { QueueSize next_size; };
layout(set = 1, binding = 7, scalar) writeonly buffer Next { uint next[]; };
layout(set = 1, binding = 8, scalar) writeonly buffer Members { uint members[]; };  // by id: 1 where final
layout(set = 1, binding = 9, scalar) writeonly buffer Finals { CutNode finals[]; }; // by id
layout(set = 1, binding = 10, scalar) readonly buffer LeafParents { uint leaf_parents[]; };
layout(set = 1, binding = 11, scalar) readonly buffer NodeParents { uint node_parents[]; };
#include "shaders/lib/density.glsl"
#include "shaders/lib/spread.glsl"

void divide(uint id)
{
    uint slot = atomicAdd(next_size.count, 2u);
    next[slot] = childId(loadTreeNode(id).left);
    next[slot + 1u] = childId(loadTreeNode(id).right);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= work_size.count)
        return;
    uint id = work[i];
    PhotonNode node = photonNode(id);
    // A node of few photons is not worth dividing: its children's estimates would share nearly all of theirs.
    bool is_last = params.last != 0u || node.count < 2u * fewestPhotons(params);
    float even = evenRadius(id, node, params);
    DensityEstimate estimate = DensityEstimate(vec3(0.0), 0.0);
    if (!is_last || params.mode == kCutNearest)
    {
        // Half as many again, so that one search mostly suffices.
        estimate = estimateIrradiance(node.center, node.normal, size.count, params.photon_count, square(reachAt(node.center, params)),
                                      1.5 * square(even));
        float exact = luminance(estimate.irradiance);
        float chance = kBeyondChance * sqrt(node.noise2 + 1.2 / float(params.photon_count));
        if (!is_last && abs(exact - node.irradiance) > max(params.difference, chance) * max(exact, node.irradiance))
        {
            divide(id);
            return;
        }
    }
    members[id] = 1u;
    // A larger node covers at least itself; few photons far apart do not determine the density between them.
    float reach = node.count > kCutFewest ? max(node.longest, even) : even;
    finals[id] = spreadNode(id, node, params.spread * reach);
    if (params.mode == kCutNearest)
        finals[id].irradiance = estimate.irradiance;
}
