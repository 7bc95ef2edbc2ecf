#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/glossy/glossy.h"

// Reads the illumination cut where glossy rays end, and follows at once what mirrors and glass send on. One thread per ray of the
// queue, one ray a pixel at most.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { GlossyParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Queue { QueueSize queue; };
layout(set = 1, binding = 1) uniform usamplerBuffer Rays;
layout(set = 1, binding = 2) uniform usamplerBuffer Hits;
layout(set = 1, binding = 3, scalar) readonly buffer States { GatherState states[]; };
layout(set = 1, binding = 4, scalar) buffer Radiance { vec3 radiance[]; };
layout(set = 1, binding = 5, scalar) readonly buffer CutSize { QueueSize cut_size; };
layout(set = 1, binding = 6) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 7) uniform usamplerBuffer CutNodes;
layout(set = 1, binding = 8, scalar) readonly buffer Directions { uint directions[]; };
#include "shaders/lib/hit.glsl"
#include "shaders/lib/ray.glsl"
#include "shaders/lib/cut_light.glsl"

Incident lightAt(vec3 x, vec3 n, uint random) { return cutLight(x, n, random); }
#include "shaders/lib/gather_vertex.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= queue.count)
        return;
    Ray ray = loadRay(i);
    Hit hit = loadHit(i);
    GatherState state = states[ray.path];
    vec3 sum = vec3(0.0);
    uint path = ray.path, depth = 0u;
    Passage passage = kNoPassage;
    bool goes_on;
    do // tests at its end: see lib/bvh.glsl why
    {
        Sampler sampler_ = Sampler(hash(params.seed, path), params.first_sample, depth * kGatherDimensions);
        GatherVertex vertex = shadeGatherVertex(ray, hit, state, passage, sampler_, true);
        sum += vertex.radiance;
        goes_on = vertex.goes_on && depth < params.depth_limit;
        if (goes_on)
        {
            ray = vertex.next;
            ++depth;
            hit = closestHit(ray.origin, ray.direction, kRayStart, ray.t_max, hash(hash(params.seed, ~depth), path));
        }
    } while (goes_on);
    if (sum != vec3(0.0))
        radiance[path] += sum;
}
