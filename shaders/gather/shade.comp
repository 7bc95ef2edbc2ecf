#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/gather/gather.h"

// Reads the illumination cut where gathering rays end. What a mirror or glass sends on is followed at once: few rays, and a queue a
// vertex would cost more than the threads that wait. One thread per ray of the queue.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { GatherParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Queue { QueueSize queue; };
layout(set = 1, binding = 1) uniform usamplerBuffer Rays;
layout(set = 1, binding = 2) uniform usamplerBuffer Hits;
layout(set = 1, binding = 3, scalar) readonly buffer States { GatherState states[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer GatheredBlock { Gathered gathered[]; };
layout(set = 1, binding = 5, scalar) readonly buffer CutSize { QueueSize cut_size; };
layout(set = 1, binding = 6) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 7) uniform usamplerBuffer CutNodes;
layout(set = 1, binding = 8, scalar) readonly buffer Directions { uint directions[]; };
#include "shaders/lib/hit.glsl"
#include "shaders/lib/ray.glsl"
#include "shaders/lib/cut_light.glsl"

Incident lightAt(vec3 x, vec3 n, uint random)
{
    if (params.mode == kCutNearest)
        return nearestCutLight(x, n, kInfinity);
    return cutLight(x, n, random);
}
#include "shaders/lib/gather_vertex.glsl"
#include "shaders/gather/shade_body.glsl"
