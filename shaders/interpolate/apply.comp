#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/interpolate/interpolate.h"
#include "shaders/lib/bsdf.glsl"
#include "shaders/lib/variation.glsl"

// Indirect diffuse light of every pixel from the samples whose support holds its shading point. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { InterpolateParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer TreeNodes { TreeNode tree_nodes[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Samples { Sample samples[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Points { ShadingPoint points[]; };
layout(set = 1, binding = 4, scalar) buffer Radiance { vec3 radiance[]; };
layout(set = 1, binding = 5, scalar) buffer Statistics { InterpolateStatistics statistics; };
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

vec3 interpolatedIrradiance(vec3 x, vec3 n)
{
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    uint first, end;
    beginRanges(size.count);
    while (nextRange(x, 0.0, first, end))
        for (uint i = first; i < end; ++i)
        {
            Sample s = samples[i];
            float weight = sampleWeight(s, x, n);
            sum += weight * s.irradiance;
            weights += weight;
        }
    return weights > 0.0 ? sum / weights : nearestIrradiance(x, n);
}

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.point_count || points[pixel].slot == kNone)
        return;
    ShadingPoint point = points[pixel];
    Surface s = surfaceAt(point.slot, point.barycentrics, point.direction);
    Bsdf b = bsdfAt(materialAt(s), s.front);
    vec3 reflectance = point.throughput * diffuseReflectance(b, max(0.0, -dot(s.normal, point.direction)));
    if (params.white != 0u)
        reflectance = mix(vec3(0.0), vec3(1.0), notEqual(reflectance, vec3(0.0)));
    if (reflectance != vec3(0.0))
        radiance[pixel] += reflectance * kInvPi * interpolatedIrradiance(s.position, s.smooth_normal);
}
