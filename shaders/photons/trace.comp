#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/emission.glsl"
#include "shaders/lib/path.glsl"
#include "shaders/lib/trace.glsl"
#include "shaders/photons/photons.h"

// Follows photons through the scene: stores one wherever light scatters, then sends it on or absorbs it by Russian roulette.
// One thread per path, to its end: paths are few against the rays of a frame, and a queue a bounce would cost more than the
// threads that wait. Photons are appended as they come, with tags by which place.comp makes an order that does not depend on
// that of threads. Where they were too many for the store, a second dispatch writes those of the paths that fit whole.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { TraceParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Starts { PhotonStart starts[]; };
layout(set = 1, binding = 1, scalar) writeonly buffer Photons { Photon photons[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Tags { PhotonTag tags[]; };
layout(set = 1, binding = 3, scalar) buffer Appended { uint appended; }; // photons, also those there was no room for
layout(set = 1, binding = 4, scalar) writeonly buffer Counts { uint counts[]; }; // by path: its photons
layout(set = 1, binding = 5, scalar) readonly buffer Offsets { uint offsets[]; }; // the rest where params.again: by path
layout(set = 1, binding = 6, scalar) readonly buffer Store { PhotonStore store; };
layout(set = 1, binding = 7, scalar) writeonly buffer Slots { uint slots[]; };
layout(set = 1, binding = 8, scalar) buffer Traced { QueueSize traced; }; // rays

struct PathState // between two vertices
{
    vec3 power;
    uint medium;   // material index of the absorbing medium it is in, or kNone
    uint specular; // delta events since the light
    uint stored;   // photons so far
};

const float kMostGain = 16.0; // limits the power of photons at grazing angles

bool finite(vec3 v) { return !any(isnan(v)) && !any(isinf(v)); }

/// What a photon that arrives along `direction` gives a surface whose shading normal is not that of its geometry: the light
/// that a path from the eye would find there goes by the cosine to the one, the photons that arrive by that to the other.
float shadingGain(Surface s, vec3 direction)
{
    return clamp(dot(s.normal, direction) / dot(s.geometric_normal, direction), 0.0, kMostGain);
}

void storePhoton(uint path, inout PathState state, Surface s, vec3 direction)
{
    bool wanted = params.caustic == 0u || state.specular > 0u;
    if (!wanted || !finite(state.power) || state.power == vec3(0.0))
        return;
    uint number = state.stored++;
    uint slot = params.again != 0u ? offsets[path] + number : atomicAdd(appended, 1u);
    if (slot >= params.capacity)
        return;
    vec3 power = state.power * shadingGain(s, direction);
    photons[slot] = Photon(s.position, packNormal(direction), power, packNormal(s.geometric_normal));
    if (params.again != 0u)
        slots[slot] = slot;
    else
        tags[slot] = PhotonTag(path, number);
}

/// Probability that a path goes on after its event number `event`, where `reflected` of its light does.
float survivalOf(uint event, float reflected)
{
    return min(reflected, event < kFreeEvents ? kMostSurvival : kLateSurvival);
}

/// Photons have the more power the farther from the viewer they fall, and the fewer of them return: some are aimed at what is in
/// view, with power in proportion to the probability of that direction, in place of few and bright ones.
const float kAimedBounces = 0.3;
const float kFarVertex = 1.25; // view distances: nearer vertices are in view themselves

/// Number of spheres around the viewer that photons are aimed at from a vertex at this distance: of one view distance, of two, four
/// and so on, up to 0.8 of the way. What lies between the view and the vertex gets photons of a power between theirs.
uint viewSphereCount(float distance) { return uint(max(log2(0.8 * distance / view_scale.distance), 0.0)) + 1u; }

/// Each half as likely as the next smaller one.
float viewSphereProbability(uint i, uint count) { return exp2(-float(min(i + 1u, count - 1u))); }

float viewConeHeight(uint i, vec3 position)
{
    return coneHeight(CausticTarget(view_scale.focus, exp2(float(i)) * view_scale.distance), position);
}

/// A direction towards one of the spheres. @param axis unit, to their center
vec3 aimedDirection(vec3 position, vec3 axis, uint count, vec2 random)
{
    uint i = 0u;
    float rest = random.x; // of the random number, for the direction
    while (i + 1u < count && rest >= 0.5)
    {
        rest = 2.0 * rest - 1.0;
        ++i;
    }
    if (i + 1u < count)
        rest *= 2.0;
    return frameAround(axis) * uniformCone(viewConeHeight(i, position), vec2(rest, random.y));
}

/// Its density per steradian. @param cosine of the angle to the axis
float aimedPdf(vec3 position, float cosine, uint count)
{
    float pdf = 0.0;
    for (uint i = 0u; i < count; ++i)
    {
        float height = viewConeHeight(i, position);
        pdf += cosine >= 1.0 - height ? viewSphereProbability(i, count) / (2.0 * kPi * height) : 0.0;
    }
    return pdf;
}

/// One sample of the BSDF or of the directions towards the view (one-sample model, balance heuristic; Veach 1997, 9.2.4).
/// @return whether it was aimed
bool aimBounce(PathVertex v, vec2 random, inout BsdfSample next)
{
    vec3 position = v.surface.position, to_focus = view_scale.focus - position;
    float distance = length(to_focus);
    if (!(distance >= kFarVertex * view_scale.distance))
        return false;
    vec3 axis = to_focus / distance;
    uint count = viewSphereCount(distance);
    float pick = random.x / kAimedBounces;
    bool aimed = pick < 1.0;
    if (aimed)
        next.wi = aimedDirection(position, axis, count, vec2(pick, random.y)) * v.frame;
    else if (next.pdf == 0.0) // a delta lobe is found by its own sample alone
    {
        next.weight /= 1.0 - kAimedBounces;
        return false;
    }
    BsdfValue f = evaluateBsdf(v.bsdf, v.wo, next.wi);
    next.pdf = (1.0 - kAimedBounces) * f.pdf + kAimedBounces * aimedPdf(position, dot(v.frame * next.wi, axis), count);
    next.weight = next.pdf > 0.0 ? (f.diffuse + f.specular) * abs(next.wi.z) / next.pdf : vec3(0.0);
    next.passed = false;
    if (aimed)
        next.refracted = next.wi.z < 0.0 && !v.bsdf.thin && v.bsdf.transmission > 0.0;
    return aimed;
}

/// What happens to a photon where its ray ends. @return whether it goes on, by `ray`
bool scatter(uint path, uint event, Hit hit, inout PathState state, inout Ray ray)
{
    vec3 direction = ray.direction;
    PathVertex v = vertexAt(ray, hit);
    Surface s = v.surface;
    if (isUnlit(v))
        return false;
    state.power *= transmittanceTo(v, state.medium, hit.t);
    if (hasDensity(v.bsdf))
        storePhoton(path, state, s, direction);

    Sampler sampler_ = Sampler(params.seed, params.first_path + path, kEmitDimensions + event * kScatterDimensions);
    vec2 u = nextPair(sampler_), choice = nextPair(sampler_), aim = nextPair(sampler_);
    disperse(v, state.power, aim.y);
    BsdfSample next = sampleBsdf(v.bsdf, v.wo, choice.x, u);
    bool aimed = params.caustic == 0u && aimBounce(v, aim, next);
    vec3 wi = v.frame * next.wi;
    bool delta = next.pdf == 0.0;
    // A caustic path ends where light scatters; a smooth layer over a diffuse base may still reflect it on.
    if (next.weight == vec3(0.0) || !geometryAgrees(s, wi, next.wi.z) || (params.caustic != 0u && !delta) ||
        state.stored >= params.bounce_limit)
        return false;
    vec3 weight = next.weight;
    if (next.refracted) // power is not squeezed into a smaller solid angle as radiance is
        weight *= v.bsdf.eta * v.bsdf.eta;
    // The adjoint of what a path from the eye does there (Veach 1997, 5.3).
    weight *= shadingGain(s, direction) / max(shadingGain(s, wi), 1.0 / kMostGain);
    vec3 scattered = state.power * weight;
    float reflected = luminance(scattered) / max(luminance(state.power), 1e-30);
    float survival = survivalOf(event, aimed ? 1.0 : reflected); // aimed photons keep their low power
    if (choice.y >= survival)
        return false;
    state.power = scattered / survival;
    state.medium = mediumAfter(v, next, state.medium);
    state.specular += uint(delta && !next.passed);
    ray = leavingRay(s, wi, kInfinity, path);
    return true;
}

void main()
{
    uint path = gl_GlobalInvocationID.x;
    bool repeats = params.again != 0u;
    if (path >= (repeats ? store.path_count : params.path_count))
        return;
    Ray ray = Ray(starts[path].origin, kInfinity, starts[path].direction, path);
    PathState state = PathState(starts[path].power, kNone, 0u, 0u);
    if (repeats) // fewer paths carry the light of all
        state.power *= float(params.path_count) / float(store.path_count);
    uint event = 0u;
    for (bool goes_on = state.power != vec3(0.0); goes_on; ++event)
    {
        Hit hit = closestHit(ray.origin, ray.direction, kRayStart, ray.t_max, hash(hash(params.seed, event), params.first_path + path));
        goes_on = hit.slot != kNone;
        if (goes_on)
            goes_on = scatter(path, event, hit, state, ray);
    }
    if (!repeats)
        counts[path] = state.stored;
    atomicAdd(traced.count, event);
}
