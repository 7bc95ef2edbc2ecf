#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/direct/direct.h"
#include "shaders/lib/lights.glsl"
#include "shaders/lib/trace.glsl"

// Adds the emission at the ends of BSDF-sampled rays that hit an emitter or the environment, also through thin walls, as shadow
// rays pass them, too. One thread per ray of the queue; at most one ray a point, so the sum does not depend on thread order.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { EmittedParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer EmitterQueue { QueueSize emitter_queue; };
layout(set = 1, binding = 1) uniform usamplerBuffer Rays;
layout(set = 1, binding = 2) uniform usamplerBuffer Hits;
layout(set = 1, binding = 3, scalar) readonly buffer EmitterRays { EmitterRay emitter_rays[]; };
layout(set = 1, binding = 4, scalar) buffer Radiance { vec3 radiance[]; };
layout(set = 1, binding = 5, scalar) readonly buffer Densities { float densities[]; }; // of a light in its cluster, over its pmf
#include "shaders/lib/hit.glsl"
#include "shaders/lib/ray.glsl"

/// What the ray meets there, weighted against the shadow rays that could have found it too.
vec3 emittedLight(Hit hit, vec3 direction, float pdf)
{
    if (hit.slot == kNone)
    {
        vec3 light = environmentRadiance(direction);
        return light == vec3(0.0) ? light : light * misWeight(pdf, densities[scene.environment_light] * environmentPdf(direction));
    }
    uint light = loadTriangle(loadBvhTriangle(hit.slot).triangle).light;
    if (light == kNone)
        return vec3(0.0);
    Surface s = surfaceAt(hit.slot, hit.barycentrics, direction);
    if (!emits(s))
        return vec3(0.0);
    float light_pdf = densities[light] * trianglePdf(light, s.area, hit.t, abs(dot(s.geometric_normal, direction)));
    return surfaceEmission(s.material, s.uv0, s.uv1, s.footprints) * misWeight(pdf, light_pdf);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= emitter_queue.count)
        return;
    Ray ray = loadRay(i);
    Hit hit = loadHit(i);
    vec3 through = vec3(1.0);
    vec3 light = emittedLight(hit, ray.direction, emitter_rays[i].pdf);
    bool goes_on = kSceneHasThin && hit.slot != kNone;
    if (goes_on)
        do // tests at its end: see lib/bvh.glsl why
        {
            through *= thinTransmittance(hit, ray.direction);
            goes_on = through != vec3(0.0);
            if (goes_on)
            {
                hit = closestHit(ray.origin, ray.direction, Place(hit.t, hitRank(hit.slot)), kInfinity, hash(params.seed, ray.path));
                light += through * emittedLight(hit, ray.direction, emitter_rays[i].pdf);
                goes_on = hit.slot != kNone;
            }
        } while (goes_on);
    if (light != vec3(0.0))
        radiance[ray.path] += emitter_rays[i].throughput * light;
}
