// Triangle meshes in object space, as read from one glTF primitive, and the attributes generated where it has none.
#pragma once
#include "compiler/scene_data.h"

#include <optional>
#include <vector>

/// The joints of each vertex with their weights, which sum to 1.
struct Influences
{
    uint32_t per_vertex = 0;          // 0: no joints move the primitive
    std::vector<uint32_t> joints;     // [per_vertex * vertex_count] below the skin's number of joints
    std::vector<float> weights;       // [per_vertex * vertex_count] 0 or more
    uint64_t weightless_vertices = 0; // had no weights and follow the first joint that they name
};

/// Displacements of one morph target, for a weight of 1.
struct MorphTarget
{
    std::vector<gpu::vec3> positions; // empty or one per vertex
    std::vector<gpu::vec3> normals;
    std::vector<gpu::vec3> tangents;
};

/// The vertices of a primitive that moves, in the space of its mesh and without morphing.
struct MovingVertices
{
    std::vector<gpu::vec3> positions; // [vertex_count] of the primitive
    std::vector<gpu::vec3> normals;   // likewise
    std::vector<gpu::vec4> tangents;  // likewise, or empty
    std::vector<bool> mirrored;       // likewise: whether joints mirror it at rest; empty where a node places it
    std::vector<uint32_t> sources;    // [vertex_count] the file's vertex, of which are:
    Influences influences;
    std::vector<MorphTarget> targets; // empty where no animation sets their weights
};

struct MeshPrimitive
{
    std::vector<gpu::vec3> positions;
    std::vector<gpu::vec3> normals;       // empty or one per vertex
    std::vector<gpu::vec4> tangents;      // empty or one per vertex; w: sign of the bitangent
    std::vector<gpu::vec2> uv0;           // empty or one per vertex
    std::vector<gpu::vec2> uv1;           // empty or one per vertex
    std::vector<gpu::vec4> colors;        // empty or one per vertex, linear
    std::vector<gpu::uvec3> triangles;    // vertex indices, all in range
    uint32_t material = 0;                // index into SceneData::materials
    std::vector<uint32_t> sources;        // empty or one per vertex: the file's vertex that it is a copy of
    std::optional<MovingVertices> moving; // where animations move it; the arrays above have it at rest
};

/// Appends a copy of vertex `v` to every array that has vertices but the normals. @return its index
uint32_t duplicateVertex(MeshPrimitive& mesh, uint32_t v);

/// Makes smooth normals: vertices at one position are welded, edges sharper than `crease_angle` (radians) stay sharp.
/// Vertices may be added or split. @return how many vertices have made normals: all
uint64_t generateNormals(MeshPrimitive& mesh, float crease_angle);
