#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/trace.glsl"

// Adds each shadow ray's radiance to its path unless a surface is in between. One thread per ray; at most one ray a
// path and dispatch, so the sum does not depend on thread order.

layout(local_size_x = kRaysGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Queue { QueueSize queue; };
layout(set = 1, binding = 1, scalar) readonly buffer ShadowRays { ShadowRay shadow_rays[]; };
layout(set = 1, binding = 2, scalar) buffer Radiance { vec3 radiance[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= queue.count)
        return;
    Ray ray = shadow_rays[i].ray;
    vec3 through = transmittance(ray.origin, ray.direction, ray.t_max);
    if (through != vec3(0.0))
        radiance[ray.path] += through * shadow_rays[i].radiance;
}
