#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/cut/cut.h"

// Lists the nodes of the coarse cut. One thread per id; the order of the list does not matter.

layout(local_size_x = kCutGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Ids { QueueSize ids; };
layout(set = 1, binding = 2, scalar) readonly buffer LeafParents { uint leaf_parents[]; };
layout(set = 1, binding = 3, scalar) readonly buffer NodeParents { uint node_parents[]; };
layout(set = 1, binding = 4, scalar) readonly buffer Divided { uint divided[]; };
layout(set = 1, binding = 5, scalar) buffer WorkSize { QueueSize work_size; };
layout(set = 1, binding = 6, scalar) writeonly buffer Work { uint work[]; };

void main()
{
    uint id = gl_GlobalInvocationID.x;
    if (id >= ids.count)
        return;
    bool photon = id + 1u >= size.count;
    if (!photon && divided[id] != 0u)
        return;
    bool root = id == 0u; // of a tree of one photon, too
    uint parent = root ? 0u : (photon ? leaf_parents[id + 1u - size.count] : node_parents[id]) & ~kTreeLeafBit;
    if (root || divided[parent] != 0u)
        work[atomicAdd(work_size.count, 1u)] = id;
}
