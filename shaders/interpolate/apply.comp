#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/interpolate/interpolate.h"
#include "shaders/lib/bsdf.glsl"
#include "shaders/lib/harmonics.glsl"
#include "shaders/lib/variation.glsl"

// Indirect diffuse light of every pixel from the samples whose support holds its shading point; and, where asked, what rough
// lobes reflect of their light by direction, with the same weights. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { InterpolateParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer TreeNodes { TreeNode tree_nodes[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Samples { Sample samples[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Points { ShadingPoint points[]; };
layout(set = 1, binding = 4, scalar) buffer Radiance { vec3 radiance[]; };
layout(set = 1, binding = 5, scalar) buffer Statistics { InterpolateStatistics statistics; };
layout(set = 1, binding = 6, scalar) readonly buffer Order { uint order[]; };
layout(set = 1, binding = 7, scalar) readonly buffer Harmonics { SampleHarmonics harmonics[]; };
layout(set = 1, binding = 8, scalar) readonly buffer Lobes { GlossyLobe lobes[]; };
layout(set = 1, binding = 9, scalar) writeonly buffer Shares { float shares[]; }; // of glossy light that needs no ray
layout(constant_id = 2) const bool kGlossy = false;
#include "shaders/lib/tree.glsl"

const float kLargestWeight = 100.0;

/// A sample's weight (Ward et al. 1988), taken smoothly to zero at the rim of its support so that no edge shows where one
/// sample's reach ends; 0 where it is on another surface or in front of x.
float sampleWeight(Sample s, vec3 x, vec3 n)
{
    vec3 d = x - s.position;
    float distance2 = dot(d, d);
    vec3 normal = unpackNormal(s.normal);
    if (distance2 >= square(s.support) || dot(n, normal) <= 0.01 || dot(d, n + normal) < -0.01 * s.harmonic)
        return 0.0;
    float rim = square(max(0.0, 1.0 - surfaceDistance2(d, normal) / square(s.support)));
    return rim * min(kLargestWeight, 1.0 / max(sqrt(distance2) / s.harmonic + normalVariation(n, normal), 1e-6));
}

/// Irradiance of the sample of least variation.
vec3 nearestIrradiance(vec3 x, vec3 n)
{
    uint nearest = kNone;
    float best = params.alpha * params.radius + 2.0;
    float radius2 = square(params.radius);
    uint first, end;
    beginRanges(size.count);
    while (nextRange(x, radius2, first, end))
        for (uint i = first; i < end; ++i)
        {
            float eps = geometricVariation(params.alpha, x, n, samples[i].position, unpackNormal(samples[i].normal));
            if (eps < best)
            {
                best = eps;
                nearest = i;
                radius2 = min(radius2, square(best / params.alpha));
            }
        }
    atomicAdd(statistics.fallbacks, 1u);
    if (nearest == kNone)
    {
        atomicAdd(statistics.unlit, 1u);
        return vec3(0.0);
    }
    return samples[nearest].irradiance;
}

/// Light that a sample sends into the lobe, times its evenLight.
vec3 incidentLight(Sample s, uint slot, Reflection r)
{
    uint w[12] = harmonics[slot].words;
    return s.irradiance * max(vec3(channelLight(r, w[0], w[1], w[2], w[3]), channelLight(r, w[4], w[5], w[6], w[7]),
                                   channelLight(r, w[8], w[9], w[10], w[11])), vec3(0.0));
}

struct Interpolated
{
    vec3 irradiance;
    vec3 glossy;  // pi times the radiance that the lobe sees
    bool reached; // by samples: else glossy is nothing
};

Interpolated interpolatedLight(vec3 x, vec3 n, Reflection r)
{
    vec3 sum = vec3(0.0), glossy = vec3(0.0);
    float weights = 0.0, glossy_weights = 0.0;
    uint first, end;
    beginRanges(size.count);
    while (nextRange(x, 0.0, first, end))
        for (uint i = first; i < end; ++i)
        {
            Sample s = samples[i];
            float weight = sampleWeight(s, x, n);
            sum += weight * s.irradiance;
            weights += weight;
            if (kGlossy && weight > 0.0)
            {
                glossy += weight * incidentLight(s, order[i], r);
                glossy_weights += weight * evenLight(r, unpackNormal(s.normal));
            }
        }
    return Interpolated(weights > 0.0 ? sum / weights : nearestIrradiance(x, n), glossy / max(glossy_weights, 1e-20), weights > 0.0);
}

/// The table's entry between its neighbours.
GlossyLobe lobeAt(float roughness, float cosine)
{
    vec2 at = vec2(clamp((roughness - kHarmonicsFrom) / (1.0 - kHarmonicsFrom), 0.0, 1.0) * float(kLobeRoughnesses - 1u),
                   clamp(cosine, 0.0, 1.0) * float(kLobeCosines - 1u));
    uvec2 cell = min(uvec2(at), uvec2(kLobeRoughnesses, kLobeCosines) - 2u);
    at -= vec2(cell);
    GlossyLobe sum = GlossyLobe(0.0, 0.0, 0.0, 0.0);
    for (uint corner = 0u; corner < 4u; ++corner)
    {
        uvec2 step_ = uvec2(corner & 1u, corner >> 1);
        vec2 near = mix(1.0 - at, at, equal(step_, uvec2(1u)));
        float weight = near.x * near.y;
        GlossyLobe lobe = lobes[(cell.x + step_.x) * kLobeCosines + cell.y + step_.y];
        sum = GlossyLobe(sum.height + weight * lobe.height, sum.concentration + weight * lobe.concentration,
                         sum.scale + weight * lobe.scale, sum.bias + weight * lobe.bias);
    }
    return sum;
}

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.point_count || points[pixel].slot == kNone)
        return;
    ShadingPoint point = points[pixel];
    Surface s = surfaceAt(point.slot, point.barycentrics, point.direction);
    Bsdf b = bsdfAt(materialAt(s), s.front);
    float cosine = max(0.0, -dot(s.normal, point.direction));
    vec3 reflectance = params.diffuse != 0u ? point.throughput * diffuseReflectance(b, cosine) : vec3(0.0);
    if (params.white != 0u)
        reflectance = mix(vec3(0.0), vec3(1.0), notEqual(reflectance, vec3(0.0)));
    Reflection reflection;
    vec3 glossy_reflectance = vec3(0.0);
    float share = kGlossy ? harmonicShare(b) : 0.0;
    if (kGlossy)
    {
        GlossyLobe lobe = lobeAt(sqrt(b.alpha), cosine);
        reflection = reflectionBy(lobe, s.normal, -point.direction);
        glossy_reflectance = share * point.throughput * (lobe.scale * mix(b.f0, b.base_color, b.metallic) +
                                                         lobe.bias * mix(b.f90, 1.0, b.metallic));
        shares[pixel] = 0.0;
    }
    if (reflectance == vec3(0.0) && glossy_reflectance == vec3(0.0))
        return;
    Interpolated light = interpolatedLight(s.position, s.smooth_normal, reflection);
    radiance[pixel] += reflectance * kInvPi * light.irradiance;
    if (!kGlossy || !light.reached)
        return;
    shares[pixel] = share;
    radiance[pixel] += glossy_reflectance * kInvPi * light.glossy;
}
