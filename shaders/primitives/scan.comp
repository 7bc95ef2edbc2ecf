#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/primitives/primitives.h"

// The exclusive scan of each workgroup's share, on top of the sums of the groups before.

layout(local_size_x = kPrimitivesGroupSize) in;
layout(constant_id = 0) const uint kItems = 0u; // per thread of a tile; 0: the share is one tile

layout(push_constant, scalar) uniform Push { ScanParams params; };
layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Values { uint values[]; };
layout(set = 1, binding = 2, scalar) readonly buffer GroupSums { uint group_sums[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer Sums { uint sums[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer Total { uint total_sum; };

#include "shaders/primitives/group_scan.glsl"
#include "shaders/primitives/share.glsl"

void main()
{
    const uint count = min(size.count, params.max_count);
    const uint share = shareOf(count, params.group_count, params.least_share);
    const uint group = gl_WorkGroupID.x, begin = group * share, end = min(begin + share, count);
    if (begin >= count && group > 0u)
        return;
    uint carry = 0u;
    if (group > 0u)
        groupExclusiveSum(gl_LocalInvocationIndex < group ? group_sums[gl_LocalInvocationIndex] : 0u, carry);
    const uint items = kItems > 0u ? kItems : share / kPrimitivesGroupSize;
    for (uint tile = begin; tile < end; tile += items * kPrimitivesGroupSize)
    {
        const uint first = tile + gl_LocalInvocationIndex * items, last = min(first + items, end);
        uint sum = 0u, tile_sum;
        for (uint i = first; i < last; ++i)
            sum += values[i];
        uint before = carry + groupExclusiveSum(sum, tile_sum);
        for (uint i = first; i < last; ++i)
        {
            const uint value = values[i]; // sums may be the same buffer
            sums[i] = before;
            before += value;
        }
        carry += tile_sum;
    }
    if (begin + share >= count && gl_LocalInvocationIndex == 0u)
        total_sum = carry;
}
