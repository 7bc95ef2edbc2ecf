#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/gather/gather.h"
#include "shaders/lib/aim.glsl"
#include "shaders/lib/gather_ray.glsl"

// Stratified rays from every sample, by the cosine and to where light comes from. One group per sample.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { GatherParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Samples { Sample samples[]; };
layout(set = 1, binding = 2, scalar) buffer Queue { QueueSize queue; };
layout(set = 1, binding = 3, scalar) writeonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer States { GatherState states[]; };
layout(set = 1, binding = 6) uniform usamplerBuffer Legs;
layout(set = 1, binding = 7, scalar) writeonly buffer Directions { uint directions[]; }; // octahedral, by ray

vec3 legFrom(uint index) { return uintBitsToFloat(texelFetch(Legs, int(2u * index)).xyz); }

Leg loadLeg(uint index)
{
    uvec4 a = texelFetch(Legs, int(2u * index)), b = texelFetch(Legs, int(2u * index + 1u));
    return Leg(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), uintBitsToFloat(b.w));
}

/// Sums by cell the light that the legs bring to x.
void countLegs(vec3 x, vec3 normal, mat3 frame, uint thread)
{
    const uint kEach = kLegCount / kRaysGroupSize;
    float weights[kEach];
    vec2 sum = vec2(0.0);
    for (uint k = 0u; k < kEach; ++k)
    {
        weights[k] = params.leg_count > 0u ? legWeight(loadLeg(thread + k * kRaysGroupSize), x, normal) : 0.0;
        sum += vec2(weights[k], square(weights[k]));
    }
    for (uint c = thread; c < kAimCells; c += kRaysGroupSize)
        aim_counts[c] = 0u;
    aim_sums[thread] = sum;
    for (uint half_ = kRaysGroupSize / 2u; half_ > 0u; half_ /= 2u)
    {
        barrier();
        if (thread < half_)
            aim_sums[thread] += aim_sums[thread + half_];
    }
    barrier();
    for (uint k = 0u; k < kEach; ++k)
        if (weights[k] > 0.0)
        {
            uint cell = aimCell(normalize(legFrom(thread + k * kRaysGroupSize) - x) * frame);
            atomicAdd(aim_counts[cell], uint(weights[k] / aim_sums[0].x * float(kAimWhole) + 0.5));
        }
    barrier();
}

void main()
{
    uint sample_ = gl_WorkGroupID.x, thread = gl_LocalInvocationID.x;
    if (gl_GlobalInvocationID.x == 0u)
        queue = queueSize(size.count * params.ray_count);
    if (sample_ >= size.count)
        return; // all of the group
    vec3 position = samples[sample_].position, normal = unpackNormal(samples[sample_].normal);
    mat3 frame = frameAround(normal);
    countLegs(position, normal, frame, thread);
    distributeAim(thread);
    for (uint ray = thread; ray < params.ray_count; ray += kRaysGroupSize)
    {
        float weight;
        vec2 pair = aimPair(gatherPair(sample_, ray, params.ray_count, params.seed), weight);
        vec3 direction = frame * cosineDirection(pair);
        uint i = sample_ * params.ray_count + ray;
        rays[i] = Ray(offsetOrigin(position, normal), kInfinity, direction, i);
        states[i] = GatherState(vec3(weight), kNone, 0u);
        directions[i] = packNormal(direction);
    }
}
