#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/path.glsl"
#include "shaders/lib/trace.glsl"
#include "shaders/photons/photons.h"

// Follows photons through the scene: stores one wherever light scatters, then sends it on or absorbs it by Russian roulette.
// One thread per path, to its end: paths are few against the rays of a frame, and a queue a bounce would cost more than the
// threads that wait. A path stores its n-th photon in slot n * path_count + path, so that the map does not depend on the
// order of threads.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { TraceParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Starts { PhotonStart starts[]; };
layout(set = 1, binding = 1, scalar) writeonly buffer Photons { Photon photons[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Flags { uint flags[]; };
layout(set = 1, binding = 3, scalar) buffer Traced { QueueSize traced; }; // rays

struct PathState // between two vertices
{
    vec3 power;
    uint medium;   // material index of the absorbing medium it is in, or kNone
    uint specular; // delta events since the light
    uint stored;   // scattering vertices so far
};

const float kMostGain = 16.0; // at grazing angles few photons would carry much

bool finite(vec3 v) { return !any(isnan(v)) && !any(isinf(v)); }

/// What a photon that arrives along `direction` gives a surface whose shading normal is not that of its geometry: the light
/// that a path from the eye would find there goes by the cosine to the one, the photons that arrive by that to the other.
float shadingGain(Surface s, vec3 direction)
{
    return clamp(dot(s.normal, direction) / dot(s.geometric_normal, direction), 0.0, kMostGain);
}

void store(uint path, PathState state, Surface s, vec3 direction)
{
    bool wanted = params.caustic == 0u || state.specular > 0u;
    if (!wanted || !finite(state.power) || state.power == vec3(0.0))
        return;
    uint slot = state.stored * params.path_count + path;
    vec3 power = state.power * shadingGain(s, direction);
    photons[slot] = Photon(s.position, packNormal(direction), power, packNormal(s.geometric_normal));
    flags[slot] = 1u;
}

/// What happens to a photon where its ray ends. @return whether it goes on, by `ray`
bool scatter(uint path, uint event, Hit hit, inout PathState state, inout Ray ray)
{
    vec3 direction = ray.direction;
    Surface s = surfaceAt(ray, hit);
    SurfaceMaterial m = materialAt(s);
    if ((m.flags & kMaterialUnlit) != 0u)
        return false;
    state.power *= mediumTransmittance(crossedMedium(state.medium, s, m), hit.t);
    Bsdf b = bsdfAt(m, s.front);
    if (hasDensity(b))
    {
        store(path, state, s, direction);
        ++state.stored;
    }

    mat3 frame = frameAround(s.normal);
    vec3 wo = -direction * frame;
    Sampler sampler_ = Sampler(params.seed, params.first_path + path, kEmitDimensions + event * kScatterDimensions);
    vec2 u = nextPair(sampler_), choice = nextPair(sampler_);
    BsdfSample next = sampleBsdf(b, wo, choice.x, u);
    vec3 wi = frame * next.wi;
    bool delta = next.pdf == 0.0;
    // A caustic path ends where light scatters; a smooth layer over a diffuse base may still reflect it on.
    if (next.weight == vec3(0.0) || !geometryAgrees(s, wi, next.wi.z) || (params.caustic != 0u && !delta) ||
        state.stored >= params.bounce_limit)
        return false;
    bool entered = next.wi.z < 0.0 && !next.passed;
    vec3 weight = next.weight;
    if (entered && !b.thin) // power is not squeezed into a smaller solid angle as radiance is
        weight *= b.eta * b.eta;
    // The adjoint of what a path from the eye does there (Veach 1997, 5.3).
    weight *= shadingGain(s, direction) / max(shadingGain(s, wi), 1.0 / kMostGain);
    vec3 scattered = state.power * weight;
    float survival = min(1.0, luminance(scattered) / max(luminance(state.power), 1e-30));
    if (choice.y >= survival)
        return false;
    state.power = scattered / survival;
    if (entered)
        state.medium = s.front && enclosesMedium(s, m) ? s.material : kNone;
    state.specular += uint(delta && !next.passed);
    ray = leavingRay(s, wi, kInfinity, path);
    return true;
}

void main()
{
    uint path = gl_GlobalInvocationID.x;
    if (path >= params.path_count || starts[path].power == vec3(0.0))
        return;
    Ray ray = Ray(starts[path].origin, kInfinity, starts[path].direction, path);
    PathState state = PathState(starts[path].power, kNone, 0u, 0u);
    uint event = 0u;
    for (bool goes_on = true; goes_on && event < params.event_limit; ++event)
    {
        Hit hit = closestHit(ray.origin, ray.direction, kRayStart, ray.t_max, hash(hash(params.seed, event), params.first_path + path));
        goes_on = hit.slot != kNone;
        if (goes_on)
            goes_on = scatter(path, event, hit, state, ray);
    }
    atomicAdd(traced.count, event);
}
