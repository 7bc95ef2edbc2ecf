#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/gather/gather.h"
#include "shaders/lib/harmonics.glsl"

// The light of every sample by direction. One group per sample, so that the order of the sum is fixed: the group takes its
// threads' rays together, then each of 48 threads sums one coefficient of one channel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { GatherParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer GatheredBlock { Gathered gathered[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Harmonics { SampleHarmonics harmonics[]; };
layout(set = 1, binding = 4, scalar) readonly buffer Directions { uint directions[]; }; // octahedral, by ray

shared float basis[kRaysGroupSize][kHarmonicsCount]; // the last is 1: the sum that the others are relative to
shared float light[kRaysGroupSize][3];
shared float sums[3u * kHarmonicsCount];

void main()
{
    uint sample_ = gl_WorkGroupID.x, t = gl_LocalInvocationID.x;
    bool exists = sample_ < size.count;
    float sum = 0.0;
    for (uint first = 0u; first < params.ray_count; first += kRaysGroupSize)
    {
        uint ray = first + t, i = sample_ * params.ray_count + ray;
        bool looks = exists && ray < params.ray_count;
        vec4 b[4] = harmonicBasis(looks ? unpackNormal(directions[i]) : vec3(0.0, 0.0, 1.0));
        b[3].w = 1.0;
        vec3 radiance = looks ? gathered[i].radiance : vec3(0.0);
        for (uint k = 0u; k < kHarmonicsCount; ++k)
            basis[t][k] = b[k / 4u][k % 4u];
        for (uint channel = 0u; channel < 3u; ++channel)
            light[t][channel] = radiance[channel];
        barrier();
        for (uint i = 0u; t < 3u * kHarmonicsCount && i < kRaysGroupSize; ++i)
            sum += basis[i][t % kHarmonicsCount] * light[i][t / kHarmonicsCount];
        barrier();
    }
    if (t < 3u * kHarmonicsCount)
        sums[t] = sum;
    barrier();
    if (t >= 12u || !exists)
        return;
    float whole = sums[t / 4u * kHarmonicsCount + kHarmonicsCount - 1u];
    vec4 shares = vec4(0.0);
    for (uint k = 0u; whole > 0.0 && k < (t % 4u == 3u ? 3u : 4u); ++k)
        shares[k] = sums[4u * t + k] / whole;
    harmonics[sample_].words[t] = packSnorm4x8(shares);
}
