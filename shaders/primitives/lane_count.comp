#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/primitives/primitives.h"

// How often each digit occurs in each worker's share. Every thread is a worker and counts for itself.

layout(local_size_x = kLanes) in;
layout(constant_id = 0) const uint kKeyWords = 1u;

layout(push_constant, scalar) uniform Push { SortParams params; };
layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Keys { uint keys[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Counts { uint counts[]; }; // [worker][digit]

shared uint s_counts[kMaxDigits * kLanes];

#include "shaders/primitives/digit.glsl"
#include "shaders/primitives/share.glsl"

void main()
{
    const uint worker = gl_GlobalInvocationID.x, lane = gl_LocalInvocationIndex;
    const uint count = min(size.count, params.max_count);
    const uint share = shareOf(count, params.worker_count, kLaneLeast);
    const uint begin = worker * share, end = min(begin + share, count);
    if (begin >= count)
        return;
    const uint digits = 1u << params.digit_bits;
    for (uint d = 0u; d < digits; ++d)
        s_counts[d * kLanes + lane] = 0u;
    for (uint i = begin; i < end; ++i)
    {
        const uvec2 key = uvec2(keys[i * kKeyWords], kKeyWords > 1u ? keys[i * kKeyWords + 1u] : 0u);
        s_counts[digitOf(key, params.first_bit, params.digit_bits) * kLanes + lane] += 1u;
    }
    for (uint d = 0u; d < digits; ++d)
        counts[worker * digits + d] = s_counts[d * kLanes + lane];
}
