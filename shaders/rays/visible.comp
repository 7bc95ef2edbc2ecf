#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/trace.glsl"

// Adds each shadow ray's radiance to its path unless a surface is in between. One thread per ray; at most one ray a
// path and dispatch, so the sum does not depend on thread order.

layout(local_size_x = kRaysGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Queue { QueueSize queue; };
layout(set = 1, binding = 1) uniform usamplerBuffer ShadowRays;
layout(set = 1, binding = 2, scalar) buffer Radiance { vec3 radiance[]; };

ShadowRay loadShadowRay(uint index)
{
    int row = int(3u * index);
    uvec4 a = texelFetch(ShadowRays, row), b = texelFetch(ShadowRays, row + 1), c = texelFetch(ShadowRays, row + 2);
    return ShadowRay(Ray(uintBitsToFloat(a.xyz), uintBitsToFloat(a.w), uintBitsToFloat(b.xyz), b.w), uintBitsToFloat(c.xyz), 0.0);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= queue.count)
        return;
    ShadowRay shadow = loadShadowRay(i);
    vec3 through = transmittance(shadow.ray.origin, shadow.ray.direction, shadow.ray.t_max);
    if (through != vec3(0.0))
        radiance[shadow.ray.path] += through * shadow.radiance;
}
