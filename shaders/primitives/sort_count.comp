#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/primitives/primitives.h"

// How often each digit occurs in each workgroup's share.

layout(local_size_x = kPrimitivesGroupSize) in;
layout(constant_id = 0) const uint kKeyWords = 1u;

layout(push_constant, scalar) uniform Push { SortParams params; };
layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Keys { uint keys[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Counts { uint counts[]; }; // [digit][worker]

shared uint s_counts[kMaxDigits];

#include "shaders/primitives/digit.glsl"
#include "shaders/primitives/share.glsl"

void main()
{
    const uint thread = gl_LocalInvocationIndex, worker = gl_WorkGroupID.x;
    const uint count = min(size.count, params.max_count);
    const uint share = shareOf(count, params.worker_count, kSortTile);
    const uint begin = worker * share, end = min(begin + share, count);
    if (begin >= count)
        return;
    s_counts[thread] = 0u;
    barrier();
    for (uint i = begin + thread; i < end; i += kPrimitivesGroupSize)
    {
        const uvec2 key = uvec2(keys[i * kKeyWords], kKeyWords > 1u ? keys[i * kKeyWords + 1u] : 0u);
        atomicAdd(s_counts[digitOf(key, params.first_bit, params.digit_bits)], 1u);
    }
    barrier();
    if (thread < 1u << params.digit_bits)
        counts[thread * params.worker_count + worker] = s_counts[thread];
}
