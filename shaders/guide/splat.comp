#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/voxel.glsl"

// Splats the ends of gathering rays into the importance map: counts them by place. One thread per kGuideSplatStride rays of the queue.

layout(local_size_x = kGuideGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Queue { QueueSize queue; };
layout(set = 1, binding = 1) uniform usamplerBuffer Rays;
layout(set = 1, binding = 2) uniform usamplerBuffer Hits;
layout(set = 1, binding = 3, scalar) buffer Importance { uint importance[]; }; // by place, 0 before
#include "shaders/lib/hit.glsl"
#include "shaders/lib/ray.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x * kGuideSplatStride;
    if (i >= queue.count)
        return;
    Ray ray = loadRay(i);
    Hit hit = loadHit(i);
    if (hit.slot == kNone)
        return;
    BvhTriangle triangle = loadBvhTriangle(hit.slot);
    vec3 normal = cross(triangle.v1 - triangle.v0, triangle.v2 - triangle.v0);
    vec3 position = ray.origin + hit.t * ray.direction;
    atomicAdd(importance[binOf(position, dot(normal, ray.direction) > 0.0 ? -normal : normal)], 1u);
}
