#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/lib/scene.glsl"
#include "shaders/lib/variation.glsl"
#include "shaders/samples/samples.h"

// The same where samples are kept: their points go over to a new cluster only where that is nearer. One thread per point.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { ClusterParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Points { SamplePoint points[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Clusters { Cluster clusters[]; };
layout(set = 1, binding = 3) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 4, scalar) readonly buffer Order { uint order[]; };
layout(set = 1, binding = 5, scalar) buffer Sums { ClusterSums sums[]; };
layout(set = 1, binding = 6, scalar) writeonly buffer Owners { uvec2 owners[]; }; // by point: cluster, bits of eps
layout(set = 1, binding = 7, scalar) readonly buffer Seeds { uint seeds[]; };     // by cluster: the point it started at, ascending
layout(set = 1, binding = 8, scalar) readonly buffer Claims { uvec2 claims[]; };   // by point: the nearest kept sample or kNone, bits of eps
#include "shaders/lib/tree.glsl"

float alpha() { return params.alpha / view_scale.distance; } // of Eq. 2, per metre

uvec2 claimOf(uint point)
{
    uvec2 claim = claims[point];
    return uvec2(claim.x == kNone ? kNone : claim.x | kKeptBit, claim.y);
}
#include "shaders/samples/assign_body.glsl"
