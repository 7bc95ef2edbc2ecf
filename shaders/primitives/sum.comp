#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/primitives/primitives.h"

// The sum, or the number of flags that are set, of each workgroup's share.

layout(local_size_x = kPrimitivesGroupSize) in;
layout(constant_id = 0) const uint kFlags = 0u; // 1: count those that are not 0

layout(push_constant, scalar) uniform Push { ScanParams params; };
layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Values { uint values[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer GroupSums { uint group_sums[]; };

#include "shaders/primitives/group_scan.glsl"
#include "shaders/primitives/share.glsl"

void main()
{
    const uint count = min(size.count, params.max_count);
    const uint share = shareOf(count, params.group_count, params.least_share);
    const uint begin = gl_WorkGroupID.x * share, end = min(begin + share, count);
    if (begin >= count) // this group's sum is not used
        return;
    uint sum = 0u;
    for (uint i = begin + gl_LocalInvocationIndex; i < end; i += kPrimitivesGroupSize)
        sum += kFlags != 0u ? uint(values[i] != 0u) : values[i];
    uint total;
    groupExclusiveSum(sum, total);
    if (gl_LocalInvocationIndex == 0u)
        group_sums[gl_WorkGroupID.x] = total;
}
