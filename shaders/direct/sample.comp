#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/direct/direct.h"
#include "shaders/lib/lights.glsl"
#include "shaders/lib/path.glsl"

// Asks for direct light at every shading point twice: a shadow ray to a light chosen by power, and a ray chosen by the
// BSDF that may end on an emitter (emitted.comp weighs it). One thread per point; queues hold one ray a point at most.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { DirectParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Points { ShadingPoint points[]; };
layout(set = 1, binding = 1, scalar) buffer ShadowQueue { QueueSize shadow_queue; };
layout(set = 1, binding = 2, scalar) writeonly buffer ShadowRays { ShadowRay shadow_rays[]; };
layout(set = 1, binding = 3, scalar) buffer EmitterQueue { QueueSize emitter_queue; };
layout(set = 1, binding = 4, scalar) writeonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer EmitterRays { EmitterRay emitter_rays[]; };

void main()
{
    uint path = gl_GlobalInvocationID.x;
    if (path >= params.point_count || points[path].slot == kNone)
        return;
    ShadingPoint point = points[path];
    Surface s = surfaceAt(point.slot, point.barycentrics, point.direction);
    Bsdf b = bsdfAt(materialAt(s), s.front);
    if (!hasDensity(b))
        return;
    mat3 frame = frameAround(s.normal);
    vec3 wo = -point.direction * frame;
    uint index = params.first_sample * params.light_sample_count + params.light_sample;
    Sampler sampler_ = vertexSampler(path, point.depth + 1u, params.point_count, index, params.seed);
    vec3 throughput = point.throughput / float(params.light_sample_count);

    LightSample light = sampleLight(s.position, sampler_);
    vec3 wi = light.wi * frame;
    if (light.weight != vec3(0.0) && sidesAgree(s, light.wi, wi.z))
    {
        BsdfValue f = evaluateBsdf(b, wo, wi);
        vec3 carried = throughput * (f.diffuse + f.specular) * abs(wi.z) * light.weight;
        if (light.pdf > 0.0)
            carried *= misWeight(light.pdf, f.pdf);
        if (carried != vec3(0.0))
            shadow_rays[atomicAdd(shadow_queue.count, 1u)] = ShadowRay(shadowRay(s, light, path), carried);
    }

    vec2 u = nextPair(sampler_);
    BsdfSample next = sampleBsdf(b, wo, nextPair(sampler_).x, u);
    wi = frame * next.wi;
    if (next.pdf == 0.0 || next.weight == vec3(0.0) || !sidesAgree(s, wi, next.wi.z))
        return;
    uint slot = atomicAdd(emitter_queue.count, 1u);
    rays[slot] = leavingRay(s, wi, kInfinity, path);
    emitter_rays[slot] = EmitterRay(throughput * next.weight, next.pdf);
}
