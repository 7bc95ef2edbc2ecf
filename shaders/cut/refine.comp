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
    bool small = node.count < 2u * fewestPhotons(params);
    if (params.last == 0u && !small && !node.flat_)
    {
        divide(id);
        return;
    }
    // As if the node's photons lay evenly over its area; half as many again, so that one look mostly suffices.
    float guess2 = 1.5 * kInvPi * node.area * float(params.photon_count) / float(node.count);
    DensityEstimate estimate = estimateIrradiance(node.center, node.normal, size.count, params.photon_count, square(params.radius),
                                                  guess2 > 0.0 ? guess2 : square(params.radius) / 64.0);
    float exact = luminance(estimate.irradiance);
    bool agrees = abs(exact - node.irradiance) <= params.difference * max(exact, node.irradiance);
    if (params.last == 0u && !small && !agrees)
    {
        divide(id);
        return;
    }
    members[id] = 1u;
    finals[id] = spreadNode(id, node, params.spread * max(node.longest, sqrt(estimate.radius2)));
    if (params.mode == kCutNearest)
        finals[id].irradiance = estimate.irradiance;
}
