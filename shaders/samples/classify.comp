#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/lib/scene.glsl"
#include "shaders/lib/variation.glsl"
#include "shaders/samples/samples.h"

// Which of the last frame's samples each point of the new picture belongs to: the one of least geometric variation, where
// that is no greater than the greatest in the sample's own cluster. One thread per point.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { ClusterParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; }; // old samples
layout(set = 1, binding = 1, scalar) readonly buffer Points { SamplePoint points[]; };
layout(set = 1, binding = 2, scalar) readonly buffer OldSamples { Sample old_samples[]; };
layout(set = 1, binding = 3, scalar) readonly buffer OldTenures { SampleTenure old_tenures[]; };
layout(set = 1, binding = 4) uniform usamplerBuffer TreeNodes; // over old samples
layout(set = 1, binding = 5, scalar) readonly buffer Order { uint order[]; };
layout(set = 1, binding = 6, scalar) writeonly buffer Claims { uvec2 claims[]; }; // by point: old sample, with kKeptBit where that takes it, or
                                                                             // kNone; bits of eps
layout(set = 1, binding = 7, scalar) buffer Sums { ClusterSums sums[]; };         // by old sample
layout(set = 1, binding = 8, scalar) buffer Quota { SampleQuota quota; };         // 0 before
#include "shaders/lib/tree.glsl"

float alpha() { return params.alpha / view_scale.distance; } // of Eq. 2, per metre

void main()
{
    uint p = gl_GlobalInvocationID.x;
    if (p >= params.point_count)
        return;
    claims[p] = uvec2(kNone, 0u);
    if (points[p].pixel == kNone)
        return;
    atomicAdd(quota.point_count, 1u);
    vec3 x = points[p].position;
    vec3 n = unpackNormal(points[p].normal);
    uint owner = kNone;
    float best = kInfinity, radius2 = kInfinity;
    uint first, end;
    beginRanges(size.count);
    while (nextRange(x, radius2, first, end))
        for (uint i = first; i < end; ++i)
        {
            uint old = order[i];
            float eps = geometricVariation(alpha(), x, n, old_samples[old].position, unpackNormal(old_samples[old].normal));
            if (eps < best || (eps == best && old < owner))
            {
                best = eps;
                owner = old;
                radius2 = square(best / alpha());
            }
        }
    if (owner == kNone)
        return;
    bool takes = best <= old_tenures[owner].greatest_eps;
    claims[p] = uvec2(takes ? owner | kKeptBit : owner, floatBitsToUint(best));
    if (!takes)
        return;
    atomicAdd(quota.claimed_count, 1u);
    atomicAdd(sums[owner].count, 1u);
    atomicMin(sums[owner].least_eps, floatBitsToUint(best));
}
