#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/trace.glsl"
#include "shaders/primary/primary.h"

// Follows the chains that go on from their first vertex, to their end: few, and a queue a vertex would cost more than the threads
// that wait. One thread per ray of the queue.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ChainParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Queue { QueueSize queue; };
layout(set = 1, binding = 1) uniform usamplerBuffer Rays;
layout(set = 1, binding = 2, scalar) buffer Points { ShadingPoint points[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer DiffusePoints { DiffusePoint diffuse_points[]; };
layout(set = 1, binding = 4, scalar) buffer Radiance { vec3 radiance[]; };
#include "shaders/lib/chain.glsl"
#include "shaders/lib/ray.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= queue.count)
        return;
    Ray ray = loadRay(i);
    uint path = ray.path;
    ChainVertex c;
    c.diffuse = kNoDiffusePoint;
    c.light = radiance[path];
    vec3 throughput = points[path].throughput;
    uint medium = points[path].slot, mirror = points[path].mirror;
    float width = points[path].width;
    uint depth = 1u;
    do // tests at its end: see lib/bvh.glsl why
    {
        c.point = beginPoint(ray.direction, depth, throughput, width);
        c.point.slot = medium;
        c.point.mirror = mirror;
        Hit hit = closestHit(ray.origin, ray.direction, kRayStart, ray.t_max, hash(params.trace_seed + depth, path));
        chainVertex(c, ray, hit, depth, false);
        if (c.goes_on)
        {
            ray = c.next;
            throughput = c.point.throughput;
            medium = c.point.slot;
            mirror = c.point.mirror;
            width = c.point.width;
            ++depth;
        }
    } while (c.goes_on);
    points[path] = c.point;
    diffuse_points[path] = c.diffuse;
    radiance[path] = c.light;
}
