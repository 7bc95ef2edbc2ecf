#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/path.glsl"
#include "shaders/photons/photons.h"

// One surface of every photon's path: stores the photon where light scatters, then sends it on or absorbs it by Russian
// roulette. One thread per ray of the queue. A path stores its n-th photon in slot n * path_count + path, so that the map
// does not depend on the order of threads.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ScatterParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Queue { QueueSize queue; };
layout(set = 1, binding = 1) uniform usamplerBuffer Rays;
layout(set = 1, binding = 2) uniform usamplerBuffer Hits;
layout(set = 1, binding = 3, scalar) buffer States { PhotonState states[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer Photons { Photon photons[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer Flags { uint flags[]; };
layout(set = 1, binding = 6, scalar) buffer NextQueue { QueueSize next_queue; };
layout(set = 1, binding = 7, scalar) writeonly buffer NextRays { Ray next_rays[]; };
#include "shaders/lib/hit.glsl"
#include "shaders/lib/ray.glsl"

bool finite(vec3 v) { return !any(isnan(v)) && !any(isinf(v)); }

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= queue.count || loadHit(i).slot == kNone)
        return;
    uint path = loadRay(i).path;
    vec3 direction = loadRay(i).direction;
    Hit hit = loadHit(i);
    PhotonState state = states[path];
    Surface s = surfaceAt(hit.slot, hit.barycentrics, direction);
    SurfaceMaterial m = materialAt(s);
    if ((m.flags & kMaterialUnlit) != 0u)
        return;
    state.power *= mediumTransmittance(crossedMedium(state.medium, s, m), hit.t);
    Bsdf b = bsdfAt(m, s.front);
    bool scatters = hasDensity(b);
    if (scatters)
    {
        bool wanted = params.caustic == 0u || state.specular > 0u;
        if (wanted && finite(state.power) && state.power != vec3(0.0))
        {
            uint slot = state.stored * params.path_count + path;
            photons[slot] = Photon(s.position, packNormal(direction), state.power, packNormal(s.geometric_normal));
            flags[slot] = 1u;
        }
        ++state.stored;
    }

    mat3 frame = frameAround(s.normal);
    vec3 wo = -direction * frame;
    Sampler sampler_ = Sampler(params.seed, params.first_path + path, kEmitDimensions + params.event * kScatterDimensions);
    vec2 u = nextPair(sampler_), choice = nextPair(sampler_);
    BsdfSample next = sampleBsdf(b, wo, choice.x, u);
    vec3 wi = frame * next.wi;
    bool delta = next.pdf == 0.0;
    // A caustic path ends where light scatters; a smooth layer over a diffuse base may still reflect it on.
    if (next.weight == vec3(0.0) || !sidesAgree(s, wi, next.wi.z) || (params.caustic != 0u && !delta) ||
        state.stored >= params.bounce_limit)
        return;
    bool entered = next.wi.z < 0.0 && !next.passed;
    vec3 weight = next.weight;
    if (entered && !b.thin) // power is not squeezed into a smaller solid angle as radiance is
        weight *= b.eta * b.eta;
    vec3 scattered = state.power * weight;
    float survival = min(1.0, luminance(scattered) / max(luminance(state.power), 1e-30));
    if (choice.y >= survival)
        return;
    state.power = scattered / survival;
    if (entered)
        state.medium = s.front && enclosesMedium(s, m) ? s.material : kNone;
    state.specular += uint(delta && !next.passed);
    states[path] = state;
    next_rays[atomicAdd(next_queue.count, 1u)] = leavingRay(s, wi, kInfinity, path);
}
