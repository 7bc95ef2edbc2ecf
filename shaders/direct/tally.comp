#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/direct/survey.h"
#include "shaders/lib/math.glsl"

// Makes probabilities of the light that has arrived from each cluster. One thread per tile.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { TallyParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Arrived { vec3 arrived[]; }; // by ray, cluster, tile
layout(set = 1, binding = 1, scalar) writeonly buffer Tiles { TileLights tiles[]; };

const float kUnmet = 0.1; // part of the rays to clusters that none has reached which is shared out evenly: their light may be
                          // all but hidden at the pixels that were asked

void main()
{
    uint tile = gl_GlobalInvocationID.x;
    if (tile >= params.tile_count)
        return;
    float seen[kMostClusters], rest[kMostClusters];
    float seen_sum = 0.0, rest_sum = 0.0, rest_count = 0.0;
    for (uint c = 0u; c < params.cluster_count; ++c)
    {
        vec2 sum = vec2(0.0);
        for (uint ray = 0u; ray < kSurveyRays; ++ray)
            sum += arrived[(ray * params.cluster_count + c) * params.tile_count + tile].xy;
        bool reached = sum.x > 0.0;
        // A cluster of which one ray arrives may be seen better elsewhere: a part of what is hidden counts.
        seen[c] = reached ? sum.x + sum.y / float(kSurveyRays) : 0.0;
        rest[c] = reached ? -1.0 : sum.y;
        seen_sum += seen[c];
        rest_sum += max(rest[c], 0.0);
        rest_count += reached ? 0.0 : 1.0;
        tiles[tile].visible[c] = reached ? clamp(seen[c] / sum.y, 0.0, 1.0) : 1.0;
    }
    float evenly = rest_sum > 0.0 ? kUnmet * rest_sum / rest_count : 1.0;
    float seen_end = 0.0, rest_end = 0.0;
    for (uint c = 0u; c < params.cluster_count; ++c)
    {
        seen[c] = seen_end += seen[c];
        rest[c] = rest_end += rest[c] < 0.0 ? 0.0 : rest[c] + evenly;
    }
    for (uint c = 0u; c < params.cluster_count; ++c)
    {
        tiles[tile].seen[c] = seen[c] / max(seen_end, 1e-36);
        tiles[tile].rest[c] = rest[c] / max(rest_end, 1e-36);
    }
}
