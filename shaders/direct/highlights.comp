#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/direct/direct.h"
#include "shaders/lib/unshadowed.glsl"

// By what factor direct light has changed since the last frame because the eye has moved: highlights of lamps travel over surfaces,
// and histories, which stick to surfaces, would lag behind them. Lamps count by what the pixel's tile sees of them; the strongest of a
// cluster stands for all. Where the eye stands the factor is 1, whatever is known of the lamps. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { HighlightParams params; };

layout(set = 1, binding = 0) uniform usamplerBuffer Points;
layout(set = 1, binding = 1) uniform usamplerBuffer Picks; // which lib/light_cluster.glsl names
layout(set = 1, binding = 2) uniform usamplerBuffer Clusters;
layout(set = 1, binding = 3, scalar) readonly buffer Tiles { TileLights tiles[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer Factors { float factors[]; };

#include "shaders/lib/light_cluster.glsl"
#include "shaders/lib/point.glsl"

const float kHidden = 1.0 / 64.0; // what a lamp counts that no ray of the tile or around it has reached
const float kMost = 2.0;          // the estimate is rough: a larger factor, or one below 1 / kMost, is not trusted

/// The part of a cluster's light that the tile sees.
float seenOf(uint tile, uint cluster)
{
    if (params.cluster_count == 1u || (tiles[tile].sure >> cluster & 1u) != 0u)
        return 1.0;
    if ((tiles[tile].seen >> cluster & 1u) == 0u)
        return kHidden;
    return float(tiles[tile].visible[cluster / 4u] >> (8u * (cluster % 4u)) & 255u) * (1.0 / 255.0);
}

struct Lamp
{
    vec3 center;
    float size; // metres across
};

Lamp lampOf(LightCluster cluster)
{
    Light light = loadLight(cluster.strongest);
    if (light.kind < kLightTriangle)
        return Lamp(light.p0, 0.0);
    return Lamp((light.p0 + light.p1 + light.p2) / 3.0, sqrt(length(cross(light.p1 - light.p0, light.p2 - light.p0))));
}

/// The BSDF with lobes as wide as the lamp makes highlights (Karis 2013, "Real Shading in Unreal Engine 4").
Bsdf blurred(Bsdf b, float angle)
{
    b.alpha = min(1.0, b.alpha + 0.25 * angle);
    b.stretched = max(b.stretched, b.alpha);
    b.clearcoat_alpha = min(1.0, b.clearcoat_alpha + 0.25 * angle);
    return b;
}

float brightnessOf(Bsdf b, vec3 wo, vec3 wi)
{
    BsdfValue f = evaluateBsdf(b, wo, wi);
    return luminance(f.diffuse + f.specular);
}

float factorOf(PathVertex v, uint tile)
{
    vec3 position = v.surface.position, last_wo = normalize(params.last_eye - position) * v.frame;
    if (last_wo.z <= 0.0 || v.wo.z <= 0.0)
        return 1.0;
    float now = 0.0, last = 0.0;
    for (uint c = 0u;;) // tests at its end: see lib/bvh.glsl why
    {
        LightCluster cluster = loadCluster(params.first_cluster + c);
        Lamp lamp = lampOf(cluster);
        vec3 way = lamp.center - position;
        float distance2 = max(dot(way, way), 1e-20);
        vec3 wi = way * inversesqrt(distance2) * v.frame;
        float weight = seenOf(tile, c) * cluster.share * max(wi.z, 0.0) / distance2;
        Bsdf b = blurred(v.bsdf, lamp.size * inversesqrt(distance2));
        now += weight * brightnessOf(b, v.wo, wi);
        last += weight * brightnessOf(b, last_wo, wi);
        if (++c >= params.cluster_count)
            break;
    }
    return now > 0.0 && last > 0.0 && !isinf(now) && !isinf(last) ? clamp(now / last, 1.0 / kMost, kMost) : 1.0;
}

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.pixel_count)
        return;
    float factor = 1.0;
    ShadingPoint point = loadPoint(pixel);
    if (point.slot != kNone && point.depth == 0u) // in mirrors highlights move otherwise
    {
        PathVertex v = vertexAt(point);
        uint row = quotient(pixel, params.width);
        uint tile = row / kSurveySide * tileColumns(params.width) + (pixel - row * params.width) / kSurveySide;
        if (hasGlossyLobe(v.bsdf))
            factor = factorOf(v, tile);
    }
    factors[pixel] = factor;
}
