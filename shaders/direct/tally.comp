#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/direct/survey.h"

// Sums what the rays of a tile to a cluster have found. One thread per tile and cluster.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { TallyParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Arrived { vec2 arrived[]; }; // by ray, cluster, tile
layout(set = 1, binding = 1, scalar) writeonly buffer Sums { vec2 sums[]; };      // by cluster, tile

void main()
{
    uint i = gl_GlobalInvocationID.x, count = params.cluster_count * params.tile_count;
    if (i >= count)
        return;
    vec2 sum = vec2(0.0);
    for (uint ray = 0u; ray < kSurveyRays; ++ray)
        sum += arrived[ray * count + i];
    sums[i] = sum;
}
