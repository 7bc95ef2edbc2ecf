#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/lib/scene.glsl"
#include "shaders/lib/variation.glsl"
#include "shaders/samples/samples.h"

// Each point's nearest cluster by geometric variation: a range search, since eps >= alpha x distance, then sums of the
// clusters (Algorithm 2). One thread per point.

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
#include "shaders/lib/tree.glsl"

float alpha() { return params.alpha / view_scale.distance; } // of Eq. 2, per metre

uvec2 claimOf(uint point) { return uvec2(kNone, 0u); }
#include "shaders/samples/assign_body.glsl"
