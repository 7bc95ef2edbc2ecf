// Triangle meshes in object space, as read from one glTF primitive, and the attributes generated where it has none.
#pragma once
#include "compiler/scene_data.h"

#include <vector>

struct MeshPrimitive
{
    std::vector<gpu::vec3> positions;
    std::vector<gpu::vec3> normals;    // empty or one per vertex
    std::vector<gpu::vec4> tangents;   // empty or one per vertex; w: sign of the bitangent
    std::vector<gpu::vec2> uv0;        // empty or one per vertex
    std::vector<gpu::vec2> uv1;        // empty or one per vertex
    std::vector<gpu::vec4> colors;     // empty or one per vertex, linear
    std::vector<gpu::uvec3> triangles; // vertex indices, all in range
    uint32_t material = 0;             // index into SceneData::materials
};

/// Appends a copy of vertex `v` to every array that has vertices but the normals. @return its index
uint32_t duplicateVertex(MeshPrimitive& mesh, uint32_t v);

/// Makes smooth normals: vertices at one position are welded, edges sharper than `crease_angle` (radians) stay sharp.
/// Vertices may be added or split. @return how many vertices have made normals: all
uint64_t generateNormals(MeshPrimitive& mesh, float crease_angle);
