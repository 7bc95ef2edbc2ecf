#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/glossy/glossy.h"
#include "shaders/lib/path.glsl"
#include "shaders/lib/tile.glsl"

// A ray from every shading point with a rough specular lobe, sampled by that lobe. Faint reflections are subject to Russian
// roulette. One thread per pixel; one ray a pixel at most.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { GlossyParams params; };

layout(set = 1, binding = 0) uniform usamplerBuffer Points;
layout(set = 1, binding = 1, scalar) buffer Queue { QueueSize queue; };
layout(set = 1, binding = 2, scalar) writeonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer States { GatherState states[]; };
layout(set = 1, binding = 4, scalar) readonly buffer Shares { float shares[]; }; // of the light that is there already
#include "shaders/lib/point.glsl"

void main()
{
    uint path = tiledPixel(gl_GlobalInvocationID.x, params.width, params.point_count);
    if (path >= params.point_count)
        return;
    ShadingPoint point = loadPoint(path);
    if (point.slot == kNone)
        return;
    float missing = params.shared_ != 0u ? 1.0 - shares[path] : 1.0;
    if (missing <= 0.0)
        return;
    PathVertex v = vertexAt(point);
    if (!hasGlossyLobe(v.bsdf))
        return;
    vec3 reflected = specularReflectance(v.bsdf, v.wo.z);
    float survival = clamp(missing * luminance(reflected * point.throughput) / params.roulette_threshold, 0.05, 1.0);
    Sampler sampler_ = vertexSampler(path, point.depth + 1u, params.point_count, params.first_sample, params.seed);
    if (hasFeature(kFeatureDispersion))
        disperse(v, point.throughput, dispersionDraw(sampler_));
    Bsdf b = v.bsdf;
    LobeProbabilities p = lobeProbabilities(b, v.wo);
    float specular = glossyProbability(b, p);
    sampler_.dimension += kVertexDimensions - 2u; // those before are direct light's
    vec2 u = nextPair(sampler_), choice = nextPair(sampler_);
    if (specular == 0.0 || choice.y >= survival)
        return;
    BsdfSample next = sampleBsdf(b, v.wo, p.diffuse + choice.x * specular * 0.999999, u);
    vec3 wi = v.frame * next.wi;
    float chosen = (next.pdf - p.diffuse * max(0.0, next.wi.z) * kInvPi) / specular; // density of the specular lobes alone
    if (next.pdf == 0.0 || !(chosen > 0.0) || !sidesAgree(v.surface, wi, next.wi.z))
        return;
    vec3 weight = (next.weight - next.diffuse_weight) * (next.pdf / chosen);
    states[path] = GatherState(point.throughput * weight * (missing / survival), mediumAfter(v, next, kNone), 0u);
    rays[atomicAdd(queue.count, 1u)] = leavingRay(v.surface, wi, kInfinity, path);
}
