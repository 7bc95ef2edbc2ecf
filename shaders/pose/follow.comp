#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/pose/pose.h"

// What follows moving triangles: lights that are such triangles, spheres that caustic photons are aimed at, the scene's bounds.
// A thread does one of each.

layout(local_size_x = kPoseGroupSize) in;
layout(push_constant, scalar) uniform Params { PoseParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Emitters { PosedEmitter emitters[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Targets { PosedTarget targets[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Slots { BvhTriangle slots[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Nodes { BvhNode nodes[]; };
layout(set = 1, binding = 4, scalar) buffer Lights { Light lights[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer CausticTargets { CausticTarget caustic_targets[]; };
layout(set = 1, binding = 6, scalar) buffer Info { SceneInfo info; };

float least(vec4 v) { return min(min(v.x, v.y), min(v.z, v.w)); }
float most(vec4 v) { return max(max(v.x, v.y), max(v.z, v.w)); }
vec3 lowOf(BvhNode node) { return vec3(least(node.min_x), least(node.min_y), least(node.min_z)); }
vec3 highOf(BvhNode node) { return vec3(most(node.max_x), most(node.max_y), most(node.max_z)); }

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < params.emitter_count)
    {
        BvhTriangle t = slots[emitters[i].slot];
        lights[emitters[i].light].p0 = t.v0;
        lights[emitters[i].light].p1 = t.v1;
        lights[emitters[i].light].p2 = t.v2;
    }
    if (i < params.target_count)
    {
        BvhNode node = nodes[targets[i].node];
        vec3 low = lowOf(node), high = highOf(node);
        caustic_targets[targets[i].target] = CausticTarget(0.5 * (low + high), 0.5 * length(high - low));
    }
    if (i == 0u)
    {
        info.bounds_min = lowOf(nodes[0]);
        info.bounds_max = highOf(nodes[0]);
    }
}
