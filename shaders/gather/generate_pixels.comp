#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/gather/gather.h"
#include "shaders/lib/path.glsl"

// Rays by the diffuse lobe of every shading point of a band of pixels. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { PixelGatherParams params; };

layout(set = 1, binding = 0) uniform usamplerBuffer Points;
layout(set = 1, binding = 1, scalar) writeonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer States { GatherState states[]; };
#include "shaders/lib/point.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.point_count)
        return;
    uint first = i * params.ray_count, pixel = params.first_point + i;
    for (uint k = 0u; k < params.ray_count; ++k) // where there is nothing to gather for they end at once
        rays[first + k] = Ray(vec3(0.0), 0.0, vec3(0.0, 0.0, 1.0), first + k);
    ShadingPoint point = loadPoint(pixel);
    if (point.slot == kNone)
        return;
    PathVertex v = vertexAt(point);
    if (diffuseReflectance(v.bsdf, v.wo.z) == vec3(0.0))
        return;
    for (uint k = 0u; k < params.ray_count; ++k)
    {
        Sampler sampler_ = Sampler(hash(params.seed, pixel), params.first_ray + k, 0u);
        vec3 local = cosineDirection(nextPair(sampler_));
        vec3 wi = v.frame * local;
        if (!sidesAgree(v.surface, wi, local.z))
            continue;
        states[first + k] = GatherState(point.throughput * evaluateBsdf(v.bsdf, v.wo, local).diffuse * kPi, kNone, 0u);
        rays[first + k] = leavingRay(v.surface, wi, kInfinity, first + k);
    }
}
