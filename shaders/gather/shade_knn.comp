#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/gather/gather.h"

// The same without the cut: density estimation among all photons wherever a ray ends. One thread per ray of the queue.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { GatherParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Queue { QueueSize queue; };
layout(set = 1, binding = 1) uniform usamplerBuffer Rays;
layout(set = 1, binding = 2) uniform usamplerBuffer Hits;
layout(set = 1, binding = 3, scalar) readonly buffer States { GatherState states[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer GatheredBlock { Gathered gathered[]; };
layout(set = 1, binding = 5, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 6) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 7) uniform usamplerBuffer Photons;
#include "shaders/lib/hit.glsl"
#include "shaders/lib/ray.glsl"
#include "shaders/lib/density.glsl"
#include "shaders/lib/view_scale.glsl"

Incident lightAt(vec3 x, vec3 n, uint random)
{
    float radius2 = square(params.radius * viewDistance(x));
    return densityLight(x, n, size.count, params.photon_count, radius2, radius2 / 256.0, random);
}
#include "shaders/lib/gather_vertex.glsl"
#include "shaders/gather/shade_body.glsl"
