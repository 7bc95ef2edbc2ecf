#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/pose/pose.h"

// Winds moving triangles the other way round when two of their vertices at least begin or cease to be mirrored, as the compiler does
// with what it finds mirrored (glTF 2.0, 3.7.4): their fronts stay fronts. Runs between deform.comp and refit.comp, which
// finds where the corners were in their new order. One thread per moving triangle.

layout(local_size_x = kPoseGroupSize) in;
layout(push_constant, scalar) uniform Params { PoseParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer MovingVertices { MovingVertex moving[]; }; // and one behind the last
layout(set = 1, binding = 1, scalar) readonly buffer Influences { Influence influences[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Bones { BoneMatrix bones[]; };
layout(set = 1, binding = 3, scalar) buffer Mirrored { uint mirrored[]; }; // by moving slot: 1: wound as one that is mirrored
layout(set = 1, binding = 4, scalar) buffer Slots { BvhTriangle slots[]; };
layout(set = 1, binding = 5, scalar) buffer Triangles { Triangle triangles[]; };
#include "shaders/pose/blend.glsl"

uint mirroredCorners(uvec3 v)
{
    return uint(mirrors(blendedMatrix(v.x))) + uint(mirrors(blendedMatrix(v.y))) + uint(mirrors(blendedMatrix(v.z)));
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.slot_count)
        return;
    uint slot = params.first_slot + i, triangle = slots[slot].triangle;
    uvec3 vertices = triangles[triangle].vertices;
    uint now = mirroredCorners(vertices - params.first_vertex) >= 2u ? 1u : 0u;
    if (now == mirrored[i])
        return;
    mirrored[i] = now;
    triangles[triangle].vertices = vertices.xzy;
    vec3 second = slots[slot].v1;
    slots[slot].v1 = slots[slot].v2;
    slots[slot].v2 = second;
}
