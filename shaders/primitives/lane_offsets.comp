#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/primitives/primitives.h"

// Turns the workers' counts into where each worker's first pair of each digit goes. One workgroup, a thread per digit.

layout(local_size_x = kPrimitivesGroupSize) in;

layout(push_constant, scalar) uniform Push { SortParams params; };
layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) buffer Counts { uint counts[]; }; // [worker][digit]

#include "shaders/primitives/group_scan.glsl"
#include "shaders/primitives/share.glsl"

void main()
{
    const uint count = min(size.count, params.max_count);
    const uint share = shareOf(count, params.worker_count, kLaneLeast);
    const uint workers = (count + share - 1u) / share, digit = gl_LocalInvocationIndex;
    const uint digits = 1u << params.digit_bits;
    uint sum = 0u, total;
    if (digit < digits)
        for (uint w = 0u; w < workers; ++w)
            sum += counts[w * digits + digit];
    uint at = groupExclusiveSum(sum, total);
    if (digit < digits)
        for (uint w = 0u; w < workers; ++w)
        {
            const uint here = counts[w * digits + digit];
            counts[w * digits + digit] = at;
            at += here;
        }
}
