#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/primitives/primitives.h"

// The indices of the flags that are set, in order, each workgroup's after those of the groups before.

layout(local_size_x = kPrimitivesGroupSize) in;
layout(constant_id = 0) const uint kItems = 0u; // per thread of a tile; 0: the share is one tile

layout(push_constant, scalar) uniform Push { ScanParams params; };
layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Flags { uint flags[]; };
layout(set = 1, binding = 2, scalar) readonly buffer GroupSums { uint group_sums[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer Indices { uint indices[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer Selected { QueueSize selected; };

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
        uint set = 0u, tile_sum;
        for (uint i = first; i < last; ++i)
            set += uint(flags[i] != 0u);
        uint at = carry + groupExclusiveSum(set, tile_sum);
        for (uint i = first; i < last; ++i)
            if (flags[i] != 0u)
                indices[at++] = i;
        carry += tile_sum;
    }
    if (begin + share >= count && gl_LocalInvocationIndex == 0u)
        selected = queueSize(carry);
}
