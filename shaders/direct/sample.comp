#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/direct/direct.h"
#include "shaders/lib/lights.glsl"
#include "shaders/lib/path.glsl"

// Samples direct light at every shading point: a shadow ray to a light of the group, and, once for all groups, a BSDF-sampled
// ray that may end on an emitter (emitted.comp weights it). The light is chosen among candidates picked by power, with
// probability proportional to its unoccluded contribution (Talbot et al. 2005, "Importance Resampling for Global
// Illumination"). One thread per point; queues hold one ray a point at most.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { DirectParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Points { ShadingPoint points[]; };
layout(set = 1, binding = 1, scalar) buffer ShadowQueue { QueueSize shadow_queue; };
layout(set = 1, binding = 2, scalar) writeonly buffer ShadowRays { ShadowRay shadow_rays[]; };
layout(set = 1, binding = 3, scalar) buffer EmitterQueue { QueueSize emitter_queue; };
layout(set = 1, binding = 4, scalar) writeonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer EmitterRays { EmitterRay emitter_rays[]; };
layout(set = 1, binding = 6, scalar) readonly buffer Picks { LightPick picks[]; };

/// Picks a light of the group by power and a point or direction on it.
LightSample sampleGroup(vec3 point, Sampler s)
{
    LightDraws draws = nextLightDraws(s);
    LightPick pick = picks[params.first_pick + toIndex(draws.pick.x, params.pick_count)];
    LightSample light =
        sampleLightAt(toUnitFloat(draws.pick.y) < pick.threshold ? pick.light : pick.otherwise, point, draws);
    light.weight *= params.share;
    light.pdf /= params.share;
    return light;
}

/// What the light sends through the BSDF if nothing is in the way, over the candidate's density. Against the BSDF's ray it is
/// weighed as one sample, however many candidates there are: where the BSDF finds the light better, it keeps its say.
vec3 unshadowed(PathVertex v, LightSample light)
{
    vec3 wi = light.wi * v.frame;
    if (light.weight == vec3(0.0) || !sidesAgree(v.surface, light.wi, wi.z))
        return vec3(0.0);
    BsdfValue f = evaluateBsdf(v.bsdf, v.wo, wi);
    float mis = light.pdf > 0.0 ? misWeight(light.pdf, f.pdf) : 1.0;
    return (f.diffuse + f.specular) * abs(wi.z) * light.weight * mis;
}

void main()
{
    uint path = gl_GlobalInvocationID.x;
    if (path >= params.point_count || points[path].slot == kNone)
        return;
    ShadingPoint point = points[path];
    PathVertex v = vertexAt(point);
    Surface s = v.surface;
    if (!hasDensity(v.bsdf))
        return;
    uint index = params.first_sample * params.light_sample_count + params.light_sample;
    vec3 throughput = point.throughput / float(params.light_sample_count);
    Sampler bsdf_sampler = vertexSampler(path, point.depth + 1u, params.point_count, index, params.seed);
    if (hasFeature(kFeatureDispersion))
        disperse(v, point.throughput, dispersionDraw(bsdf_sampler));
    bsdf_sampler.dimension += kLightPairs;
    vec2 u = nextPair(bsdf_sampler), choice = nextPair(bsdf_sampler);

    LightSample chosen = kNoLight;
    vec3 carried = vec3(0.0);
    float sum = 0.0, draw = choice.y;
    for (uint k = 0u; k < params.candidate_count; ++k)
    {
        LightSample light = sampleGroup(s.position, vertexSampler(path, point.depth + 1u, params.point_count,
                                                                  index * params.candidate_count + k, params.light_seed));
        vec3 candidate = throughput * unshadowed(v, light);
        float weight = luminance(candidate);
        if (!(weight > 0.0))
            continue;
        sum += weight;
        float kept = 1.0 - weight / sum; // with this probability the choice so far stays; one draw serves for all
        if (draw < kept)
            draw /= kept;
        else
        {
            draw = (draw - kept) / (1.0 - kept);
            chosen = light;
            carried = candidate;
        }
    }
    if (sum > 0.0)
        shadow_rays[atomicAdd(shadow_queue.count, 1u)] =
            ShadowRay(shadowRay(s, chosen, path), carried * (sum / (luminance(carried) * float(params.candidate_count))));

    if (params.traces_bsdf_samples == 0u)
        return;
    BsdfSample next = sampleBsdf(v.bsdf, v.wo, choice.x, u);
    vec3 wi = v.frame * next.wi;
    if (next.pdf == 0.0 || next.weight == vec3(0.0) || !sidesAgree(s, wi, next.wi.z))
        return;
    uint slot = atomicAdd(emitter_queue.count, 1u);
    rays[slot] = leavingRay(s, wi, kInfinity, path);
    emitter_rays[slot] = EmitterRay(throughput * next.weight, next.pdf);
}
