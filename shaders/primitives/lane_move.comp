#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/primitives/primitives.h"

// Moves each pair to where its digit goes. Every thread is a worker and takes its share in order, so that equal digits
// keep theirs.

layout(local_size_x = kLanes) in;
layout(constant_id = 0) const uint kKeyWords = 1u;

layout(push_constant, scalar) uniform Push { SortParams params; };
layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Keys { uint keys[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Values { uint values[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Offsets { uint offsets[]; }; // [worker][digit]
layout(set = 1, binding = 4, scalar) writeonly buffer MovedKeys { uint moved_keys[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer MovedValues { uint moved_values[]; };

shared uint s_offsets[kMaxDigits * kLanes];

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
        s_offsets[d * kLanes + lane] = offsets[worker * digits + d];
    for (uint i = begin; i < end; ++i)
    {
        const uvec2 key = uvec2(keys[i * kKeyWords], kKeyWords > 1u ? keys[i * kKeyWords + 1u] : 0u);
        const uint counter = digitOf(key, params.first_bit, params.digit_bits) * kLanes + lane;
        const uint at = s_offsets[counter];
        s_offsets[counter] = at + 1u;
        moved_keys[at * kKeyWords] = key.x;
        if (kKeyWords > 1u)
            moved_keys[at * kKeyWords + 1u] = key.y;
        moved_values[at] = values[i];
    }
}
