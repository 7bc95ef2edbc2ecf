#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/cut/cut.h"

// Sums E~ over the level of the tree that has about kCutLevelNodes nodes. A fixed number of groups shares the nodes, so that
// the sum has one order.

layout(local_size_x = kPartialGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 2) uniform usamplerBuffer Photons;
layout(set = 1, binding = 3, scalar) readonly buffer NodeParents { uint node_parents[]; };
layout(set = 1, binding = 4, scalar) readonly buffer Sums { PhotonSums sums[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer Partials { PartialMean partials[]; };
#include "shaders/lib/photon_node.glsl"

shared float sums_[kPartialGroupSize];
shared uint counts_[kPartialGroupSize];

void main()
{
    uint level_count = max(size.count / kCutLevelNodes, kCutFewest); // photons of a node of that level at most
    float sum = 0.0;
    uint count = 0u;
    for (uint id = gl_GlobalInvocationID.x; id + 1u < size.count; id += kPartialMeans * kPartialGroupSize)
    {
        if (loadTreeNode(id).count > level_count)
            continue;
        if (id != 0u && loadTreeNode(node_parents[id] & ~kTreeLeafBit).count <= level_count)
            continue;
        sum += photonNode(id).irradiance;
        ++count;
    }
    uint t = gl_LocalInvocationID.x;
    sums_[t] = sum;
    counts_[t] = count;
    for (uint half_ = kPartialGroupSize / 2u; half_ > 0u; half_ /= 2u)
    {
        barrier();
        if (t < half_)
        {
            sums_[t] += sums_[t + half_];
            counts_[t] += counts_[t + half_];
        }
    }
    if (t == 0u)
        partials[gl_WorkGroupID.x] = PartialMean(sums_[0], counts_[0]);
}
