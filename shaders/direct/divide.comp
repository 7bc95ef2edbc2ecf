#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/direct/survey.h"

// Divides the clusters into sets by what arrives at a tile and at those around it. One thread per tile.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { TallyParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Sums { vec2 sums[]; }; // by cluster, tile
layout(set = 1, binding = 1, scalar) writeonly buffer Tiles { TileLights tiles[]; };

const float kAround = 0.125; // what a tile beside this one counts
// Part of a set's candidates that is shared out evenly: at the pixels that were asked the light of a cluster may come aslant, or be
// all but hidden. None: rare bright pixels. With .1 in all sets 4 candidates of 16 lamps did a little less than 4 samples.
const vec3 kEvenly = vec3(0.03, 0.03, 0.1);

/// Brightness of the cluster's light that arrives at the tiles around, and that would if nothing were in the way.
vec2 lightAround(uint cluster, uint tile)
{
    uvec2 tiles = uvec2(params.columns, params.rows);
    uint first = tile - tile % (tiles.x * tiles.y), in_plane = tile - first;
    ivec2 at = ivec2(in_plane % tiles.x, in_plane / tiles.x);
    ivec2 low = max(at - 1, ivec2(0)), high = min(at + 1, ivec2(tiles) - 1);
    vec2 sum = vec2(0.0);
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
            sum += sums[cluster * params.tile_count + first + uint(y) * tiles.x + uint(x)];
    return sum;
}

void main()
{
    uint tile = gl_GlobalInvocationID.x;
    if (tile >= params.tile_count)
        return;
    uint sure = 0u, seen = 0u, visible = 0u;
    float weights[kMostClusters]; // of choosing it
    vec3 weight_sums = vec3(0.0); // by set
    vec3 counts = vec3(0.0);
    for (uint c = 0u; c < params.cluster_count; ++c)
    {
        vec2 here = sums[c * params.tile_count + tile], around = lightAround(c, tile), light = mix(here, around, kAround);
        bool is_seen = around.x > 0.0, is_sure = (params.extended >> c & 1u) == 0u && here.x > 0.0 && here.x >= 0.999 * here.y; // but for rounding
        // A cluster of which one ray arrives may be seen better elsewhere: a part of what is hidden counts.
        float part = is_seen ? min(1.0, light.x / light.y + 1.0 / float(kSurveyRays)) : 1.0;
        sure |= is_sure ? 1u << c : 0u;
        seen |= is_seen && !is_sure ? 1u << c : 0u;
        visible |= uint(part * 255.0 + 0.5) << (8u * (c & 3u));
        if ((c & 3u) == 3u || c + 1u == params.cluster_count)
        {
            tiles[tile].visible[c / 4u] = visible;
            visible = 0u;
        }
        weights[c] = part * light.y;
        vec3 set = vec3(is_sure, is_seen && !is_sure, !is_seen);
        weight_sums += set * weights[c];
        counts += set;
    }
    vec3 evenly = mix(vec3(1.0), kEvenly * weight_sums, greaterThan(weight_sums, vec3(0.0))) / max(counts, vec3(1.0));
    vec3 totals = (1.0 - kEvenly) * weight_sums + evenly * counts;
    vec3 end = vec3(0.0);
    for (uint c = 0u; c < params.cluster_count; ++c)
    {
        vec3 set = vec3(sure >> c & 1u, seen >> c & 1u, ~(sure | seen) >> c & 1u);
        end += set * ((1.0 - kEvenly) * weights[c] + evenly);
        tiles[tile].ends[c] = dot(set, end / max(totals, vec3(1e-36)));
    }
    tiles[tile].sure = sure;
    tiles[tile].seen = seen;
}
