#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/lights.glsl"
#include "shaders/lib/path.glsl"
#include "shaders/reference/reference.h"

// One vertex of every path: adds what it emits, sends a shadow ray to one light, chooses the next direction.
// One thread per ray of the queue. Unbiased: next-event estimation and BSDF sampling combined by multiple importance
// sampling (Veach & Guibas 1995), Russian roulette, no clamping.
// Whatever terms are shown, a path is traced with the same random numbers as long as some of its light may still be shown:
// pictures of single terms sum to the picture of all.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ShadeParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Queue { QueueSize queue; };
layout(set = 1, binding = 1, scalar) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 3, scalar) buffer States { PathState states[]; };
layout(set = 1, binding = 4, scalar) buffer Radiance { vec3 radiance[]; };
layout(set = 1, binding = 5, scalar) buffer NextQueue { QueueSize next_queue; };
layout(set = 1, binding = 6, scalar) writeonly buffer NextRays { Ray next_rays[]; };
layout(set = 1, binding = 7, scalar) buffer ShadowQueue { QueueSize shadow_queue; };
layout(set = 1, binding = 8, scalar) writeonly buffer ShadowRays { ShadowRay shadow_rays[]; };

const uint kRouletteDepth = 3u; // vertices that are always continued
// Of the last vertices that a path may have, where it may have more than as many, every second ends it: of a room that reflects
// 0.95 of its light a limit would else cut off a part, of 64 vertices a thirtieth.
const uint kLastVertices = 32u;
const float kLastSurvival = 0.5;

PathState loadState(uint path)
{
    if (params.depth == 0u)
        return PathState(vec3(1.0), vec3(1.0), 0.0, 0.0, kNone, params.first_stage);
    return states[path];
}

bool counts(uint stage) { return (params.stages >> stage & 1u) != 0u; }
bool mayStillCount(uint stage) { return params.stages >> stage != 0u; }

/// A path's stage after a scattering vertex.
uint stageAfter(uint stage, bool delta)
{
    if (delta)
        return stage == kStageLeft ? kStageSpecular : stage;
    return stage == kStageEye ? kStageLeft : kStageDeep;
}

/// The weight in the picture of light found now.
vec3 countedThroughput(PathState state) { return state.throughput * state.share; }

/// The fraction of the sample's weight that went through the lobes that count.
vec3 countingShare(BsdfSample next)
{
    vec3 part = params.lobes == kLobeDiffuse ? next.diffuse_weight : next.weight - next.diffuse_weight;
    return params.lobes == kLobesBoth ? vec3(1.0) : part / max(next.weight, vec3(1e-30));
}

void add(uint path, vec3 found, uint stage)
{
    vec3 light = counts(stage) ? found : vec3(0.0);
    if (params.depth == 0u)
        radiance[path] = light; // the first vertex starts the sum
    else if (light != vec3(0.0))
        radiance[path] += light;
}

/// Emitted light that arrives along the path, weighted against the shadow rays that could have found it too.
vec3 emittedLight(PathVertex v, PathState state)
{
    Surface s = v.surface;
    vec3 emission = v.material.emission;
    if (emission == vec3(0.0) || !emits(s))
        return vec3(0.0);
    uint light = loadTriangle(s.triangle).light;
    if (state.pdf == 0.0 || light == kNone)
        return emission;
    float cosine = abs(dot(s.geometric_normal, s.direction));
    return emission * misWeight(state.pdf, trianglePdf(light, s.area, state.travelled, cosine));
}

void sendShadowRay(PathVertex v, PathState state, uint path, inout Sampler sampler_)
{
    Surface s = v.surface;
    LightSample light = sampleLight(s.position, sampler_);
    vec3 wi = light.wi * v.frame;
    if (light.weight == vec3(0.0) || !hasDensity(v.bsdf) || !sidesAgree(s, light.wi, wi.z))
        return;
    if (!counts(stageAfter(state.stage, false)))
        return;
    BsdfValue f = evaluateBsdf(v.bsdf, v.wo, wi);
    vec3 carried = countedThroughput(state) * (f.diffuse + f.specular) * abs(wi.z) * light.weight;
    if (light.pdf > 0.0)
        carried *= misWeight(light.pdf, f.pdf);
    if (carried == vec3(0.0))
        return;
    shadow_rays[atomicAdd(shadow_queue.count, 1u)] = ShadowRay(shadowRay(s, light, path), carried, 0.0);
}

void continuePath(PathVertex v, PathState state, uint path, inout Sampler sampler_)
{
    vec2 u = nextPair(sampler_);
    vec2 choice = nextPair(sampler_);
    BsdfSample next = sampleBsdf(v.bsdf, v.wo, choice.x, u);
    vec3 wi = v.frame * next.wi;
    if (next.weight == vec3(0.0) || !sidesAgree(v.surface, wi, next.wi.z))
        return;
    state.throughput *= next.weight;
    state.medium = mediumAfter(v, next, state.medium);
    if (params.depth >= kRouletteDepth)
    {
        // Radiance in a denser medium is smaller for as long as the path stays in it only: that is no reason to end it.
        float squeezed = state.medium == kNone ? 1.0 : square(loadMaterial(state.medium).ior);
        bool is_late = params.depth_limit > kLastVertices && params.depth + kLastVertices >= params.depth_limit;
        float survival = clamp(maxComponent(state.throughput) * squeezed, 0.05, is_late ? kLastSurvival : 0.95);
        if (choice.y >= survival)
            return;
        state.throughput /= survival;
    }
    if (!next.passed)
    {
        uint stage = stageAfter(state.stage, next.pdf == 0.0);
        if (state.stage == kStageEye && stage == kStageLeft)
            state.share = countingShare(next);
        if (!mayStillCount(stage) || state.share == vec3(0.0))
            return;
        state.stage = stage;
        state.pdf = next.pdf;
        state.travelled = 0.0;
    }
    states[path] = state;
    next_rays[atomicAdd(next_queue.count, 1u)] = leavingRay(v.surface, wi, kInfinity, path);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= queue.count)
        return;
    uint path = rays[i].path;
    vec3 direction = rays[i].direction;
    Hit hit = hits[i];
    PathState state = loadState(path);
    if (hit.slot == kNone)
    {
        vec3 light = countedThroughput(state) * environmentRadiance(direction);
        add(path, state.pdf == 0.0 ? light : light * misWeight(state.pdf, environmentPdf(direction)), state.stage);
        return;
    }

    PathVertex v = vertexAt(rays[i], hit);
    state.throughput *= transmittanceTo(v, state.medium, hit.t);
    state.travelled += hit.t;
    if (isUnlit(v)) // shows its colour to the eye, black for everything else
    {
        add(path, state.stage == kStageEye ? countedThroughput(state) * v.material.base_color : vec3(0.0), state.stage);
        return;
    }
    add(path, countedThroughput(state) * emittedLight(v, state), state.stage);
    if (params.depth + 1u >= params.depth_limit)
        return;

    Sampler sampler_ = vertexSampler(path, params.depth, params.pixel_count, params.first_sample, params.seed);
    if (hasFeature(kFeatureDispersion))
        disperse(v, state.throughput, dispersionDraw(sampler_));
    sendShadowRay(v, state, path, sampler_);
    continuePath(v, state, path, sampler_);
}
