#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/direct/direct.h"
#include "shaders/lib/lights.glsl"
#include "shaders/lib/surface.glsl"

// Adds what BSDF-sampled rays find when they end on an emitter or in the sky. One thread per ray of the queue; at most
// one ray a point, so the sum does not depend on thread order.

layout(local_size_x = kRaysGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer EmitterQueue { QueueSize emitter_queue; };
layout(set = 1, binding = 1, scalar) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 3, scalar) readonly buffer EmitterRays { EmitterRay emitter_rays[]; };
layout(set = 1, binding = 4, scalar) buffer Radiance { vec3 radiance[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= emitter_queue.count)
        return;
    vec3 direction = rays[i].direction;
    uint path = rays[i].path;
    EmitterRay ray = emitter_rays[i];
    Hit hit = hits[i];
    if (hit.slot == kNone)
    {
        vec3 light = environmentRadiance(direction);
        if (light != vec3(0.0))
            radiance[path] += ray.throughput * light * misWeight(ray.pdf, environmentPdf(direction));
        return;
    }
    uint light = loadTriangle(loadBvhTriangle(hit.slot).triangle).light;
    if (light == kNone)
        return;
    Surface s = surfaceAt(hit.slot, hit.barycentrics, direction);
    if (!emits(s))
        return;
    float pdf = trianglePdf(light, s.area, hit.t, abs(dot(s.geometric_normal, direction)));
    radiance[path] += ray.throughput * surfaceEmission(s.material, s.uv0, s.uv1) * misWeight(ray.pdf, pdf);
}
