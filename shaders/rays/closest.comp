#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/trace.glsl"

// Finds the nearest surface along each ray of a queue. One thread per ray.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { RaysParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Queue { QueueSize queue; };
layout(set = 1, binding = 1) uniform usamplerBuffer Rays;
layout(set = 1, binding = 2, scalar) writeonly buffer Hits { Hit hits[]; };
#include "shaders/lib/ray.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= queue.count)
        return;
    Ray ray = loadRay(i);
    hits[i] = closestHit(ray.origin, ray.direction, kRayStart, ray.t_max, hash(params.seed, ray.path));
}
