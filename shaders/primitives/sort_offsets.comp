#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/primitives/primitives.h"

// The exclusive scan of one digit's counts over the workers, and their sum. One workgroup a digit.

layout(local_size_x = kPrimitivesGroupSize) in;

layout(push_constant, scalar) uniform Push { SortParams params; };
layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) buffer Counts { uint counts[]; }; // [digit][worker]
layout(set = 1, binding = 2, scalar) writeonly buffer Totals { uint totals[]; }; // [digit]

#include "shaders/primitives/group_scan.glsl"
#include "shaders/primitives/share.glsl"

const uint kWorkers = kMaxSortGroups / kPrimitivesGroupSize; // of each thread

void main()
{
    const uint thread = gl_LocalInvocationIndex, row = gl_WorkGroupID.x * params.worker_count;
    const uint count = min(size.count, params.max_count);
    const uint share = shareOf(count, params.worker_count, kSortTile);
    const uint workers = (count + share - 1u) / share, first = thread * kWorkers;
    uint here[kWorkers];
    uint sum = 0u, total;
    [[unroll]] for (uint i = 0u; i < kWorkers; ++i)
    {
        here[i] = first + i < workers ? counts[row + first + i] : 0u;
        sum += here[i];
    }
    uint before = groupExclusiveSum(sum, total);
    [[unroll]] for (uint i = 0u; i < kWorkers; ++i)
    {
        if (first + i < workers)
            counts[row + first + i] = before;
        before += here[i];
    }
    if (thread == 0u)
        totals[gl_WorkGroupID.x] = total;
}
