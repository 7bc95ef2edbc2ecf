#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/gather/gather.h"
#include "shaders/lib/math.glsl"

// Irradiance and harmonic mean distance of every sample from its rays. One group per sample, so that the order of the
// sum is fixed.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { GatherParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer GatheredBlock { Gathered gathered[]; };
layout(set = 1, binding = 2, scalar) buffer Samples { Sample samples[]; };

shared vec4 sums[kRaysGroupSize];

void main()
{
    uint sample_ = gl_WorkGroupID.x, t = gl_LocalInvocationID.x;
    bool exists = sample_ < size.count;
    vec4 sum = vec4(0.0);
    for (uint i = t; exists && i < params.ray_count; i += kRaysGroupSize)
        sum += vec4(gathered[sample_ * params.ray_count + i].radiance, gathered[sample_ * params.ray_count + i].nearness);
    sums[t] = sum;
    for (uint half_ = kRaysGroupSize / 2u; half_ > 0u; half_ /= 2u)
    {
        barrier();
        if (t < half_)
            sums[t] += sums[t + half_];
    }
    if (t != 0u || !exists)
        return;
    samples[sample_].irradiance = sums[0].rgb * (kPi / float(params.ray_count));
    samples[sample_].harmonic_mean_distance = float(params.ray_count) / max(sums[0].w, 1e-6);
}
