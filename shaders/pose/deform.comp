#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/pose/pose.h"

// Morphs and skins moving vertices (glTF 2.0, 3.7.2.2 and 3.7.3): positions into a buffer of their own, normals and tangents
// into the scene. One thread per moving vertex.

layout(local_size_x = kPoseGroupSize) in;
layout(push_constant, scalar) uniform Params { PoseParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer MovingVertices { MovingVertex moving[]; }; // and one behind the last
layout(set = 1, binding = 1, scalar) readonly buffer Influences { Influence influences[]; };
layout(set = 1, binding = 2, scalar) readonly buffer MorphOffsets { MorphOffset morphs[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Bones { BoneMatrix bones[]; };
layout(set = 1, binding = 4, scalar) readonly buffer Weights { float weights[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer Positions { vec3 positions[]; };
layout(set = 1, binding = 6, scalar) writeonly buffer Vertices { VertexAttributes vertices[]; };
#include "shaders/pose/blend.glsl"

vec3 place(BoneMatrix m, vec4 p) { return vec3(dot(m.x, p), dot(m.y, p), dot(m.z, p)); }

/// Layout as in gpu_scene.h; the inverse of unpackTangent() in lib/surface.glsl.
uint packTangent(vec3 tangent, float sign_)
{
    ivec2 parts = ivec2(round(unitToOctahedral(tangent) * vec2(32767.0, 16383.0)));
    uint bits = uint(parts.x) & 0xffffu | uint(parts.y) << 17 | (sign_ < 0.0 ? 0x10000u : 0u);
    return bits == 0u ? 1u : bits; // +Z: one step beside
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.vertex_count)
        return;
    vec3 position = moving[i].position, normal = moving[i].normal, tangent = moving[i].tangent.xyz;
    for (uint k = moving[i].first_morph; k < moving[i + 1u].first_morph; ++k)
    {
        float weight = weights[morphs[k].weight];
        position += weight * morphs[k].position;
        normal += weight * morphs[k].normal;
        tangent += weight * morphs[k].tangent;
    }
    BoneMatrix m = blendedMatrix(i);
    positions[i] = place(m, vec4(position, 1.0));
    // Normals by the inverse transpose, but for its length: the cofactors with the determinant's sign.
    float side = mirrors(m) ? -1.0 : 1.0;
    vec3 turned = dot(normal, normal) > 0.0
                      ? vec3(dot(cross(m.y.xyz, m.z.xyz), normal), dot(cross(m.z.xyz, m.x.xyz), normal), dot(cross(m.x.xyz, m.y.xyz), normal))
                      : vec3(0.0);
    float size = maxComponent(abs(turned));
    if (!(size > 0.0)) // a scale of 0, along two axes at least: there is no surface to be seen
        return;
    turned = side * normalize(turned / size);
    uint vertex = params.first_vertex + i;
    vertices[vertex].normal = packNormal(turned);
    vec3 along = place(m, vec4(tangent, 0.0));
    along -= turned * dot(along, turned);
    if (dot(along, along) > 0.0)
        vertices[vertex].tangent = packTangent(normalize(along / maxComponent(abs(along))), side * moving[i].tangent.w);
}
