#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/direct/survey.h"
#include "shaders/lib/trace.glsl"
#include "shaders/lib/unshadowed.glsl"

// Sends shadow rays from random pixels of a tile to random lights of a cluster. One thread per ray; its result is the brightness
// that arrives and that would arrive if nothing were in the way.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { SurveyParams params; };

layout(set = 1, binding = 0) uniform usamplerBuffer Points;
layout(set = 1, binding = 1) uniform usamplerBuffer Clusters;
layout(set = 1, binding = 2) uniform usamplerBuffer Picks;
layout(set = 1, binding = 3, scalar) writeonly buffer Arrived { vec2 arrived[]; }; // by ray, cluster, tile
layout(set = 1, binding = 4, scalar) buffer ShadowCount { QueueSize shadow_count; };
#include "shaders/lib/light_cluster.glsl"
#include "shaders/lib/point.glsl"

layout(constant_id = 4) const bool kCountsRays = false; // for measurements

/// A random point of the tile.
uint pointOf(uint tile, vec2 u)
{
    uint height = params.pixel_count / params.width, columns = tileColumns(params.width);
    uint tiles = columns * tileColumns(height), plane = tile / tiles, in_plane = tile - plane * tiles;
    uvec2 corner = kSurveySide * uvec2(in_plane % columns, in_plane / columns);
    uvec2 side = min(uvec2(kSurveySide), uvec2(params.width, height) - corner);
    uvec2 at = corner + min(uvec2(u * vec2(side)), side - 1u);
    return plane * params.pixel_count + at.y * params.width + at.x;
}

void main()
{
    uint thread = gl_GlobalInvocationID.x;
    uint row = thread / params.tile_count, tile = thread - row * params.tile_count;
    uint ray = row / params.cluster_count, cluster = row - ray * params.cluster_count;
    if (ray >= kSurveyRays)
        return;
    Sampler s = Sampler(hash(params.seed, tile * params.cluster_count + cluster), params.first_sample * kSurveyRays + ray, 0u);
    uint path = pointOf(tile, nextPair(s));
    vec2 result = vec2(0.0);
    if (path < params.point_count && loadPoint(path).slot != kNone)
    {
        ShadingPoint point = loadPoint(path);
        PathVertex v = vertexAt(point);
        if (hasDensity(v.bsdf))
        {
            LightSample light = sampleCluster(loadCluster(params.first_cluster + cluster), v.surface.position, nextLightDraws(s));
            float bright = luminance(point.throughput * unshadowed(v, light));
            if (bright > 0.0 && !isinf(bright))
            {
                if (kCountsRays)
                    atomicAdd(shadow_count.count, 1u);
                Ray shadow = shadowRay(v.surface, light, thread);
                result = bright * vec2(luminance(transmittance(shadow.origin, shadow.direction, shadow.t_max)), 1.0);
            }
        }
    }
    arrived[thread] = result;
}
