#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/lib/scene.glsl"
#include "shaders/lib/variation.glsl"
#include "shaders/samples/samples.h"

// How far the points of every new cluster lie from its sample at most. One thread per point.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { ClusterParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Owners { uvec2 owners[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Points { SamplePoint points[]; };
layout(set = 1, binding = 2, scalar) buffer Sums { ClusterSums sums[]; };

float alpha() { return params.alpha / view_scale.distance; } // of Eq. 2, per metre

void main()
{
    uint p = gl_GlobalInvocationID.x;
    if (p >= params.point_count || owners[p].x >= kKeptBit) // a kept sample's, or kNone
        return;
    uint nearest = sums[owners[p].x].nearest;
    float eps = geometricVariation(alpha(), points[p].position, unpackNormal(points[p].normal), points[nearest].position,
                                   unpackNormal(points[nearest].normal));
    atomicMax(sums[owners[p].x].greatest_eps, floatBitsToUint(eps));
}
