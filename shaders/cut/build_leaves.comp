#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/cut/cut.h"

// The finest cut: every selected node, unrefined. Its support is that of as many photons as density estimation takes, if they
// lie as evenly as those of the nearest node above it that has more than kCutFewest: no search. One thread per node.

layout(local_size_x = kCutGroupSize) in;
layout(push_constant, scalar) uniform Params { CutParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 2) uniform usamplerBuffer Photons;
layout(set = 1, binding = 3, scalar) readonly buffer LeafParents { uint leaf_parents[]; };
layout(set = 1, binding = 4, scalar) readonly buffer NodeParents { uint node_parents[]; };
layout(set = 1, binding = 5, scalar) readonly buffer Sums { PhotonSums sums[]; };
layout(set = 1, binding = 6, scalar) readonly buffer WorkSize { QueueSize work_size; };
layout(set = 1, binding = 7, scalar) readonly buffer Work { uint work[]; };
layout(set = 1, binding = 8, scalar) writeonly buffer Members { uint members[]; };  // by id: 1 where final
layout(set = 1, binding = 9, scalar) writeonly buffer Finals { CutNode finals[]; }; // by id
#include "shaders/lib/spread.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= work_size.count)
        return;
    uint id = work[i];
    PhotonNode node = photonNode(id);
    members[id] = 1u;
    finals[id] = spreadNode(id, node, params.spread * evenRadius(id, node, params));
}
