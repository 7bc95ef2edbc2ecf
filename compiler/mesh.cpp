#include "compiler/mesh.h"

#include "compiler/encode.h"
#include "compiler/linear.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <array>
#include <bit>
#include <cstring>
#include <unordered_map>

namespace
{
struct SurfaceTraits : OpenMesh::DefaultTraits
{
    using Point = OpenMesh::Vec3d; // object space may be of any scale
    using Normal = OpenMesh::Vec3d;
    FaceAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::PrevHalfedge |
                       OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    VertexAttributes(OpenMesh::Attributes::Status);
};
using Surface = OpenMesh::TriMesh_ArrayKernelT<SurfaceTraits>;

using PositionKey = std::array<uint32_t, 3>;
struct KeyHash
{
    size_t operator()(const PositionKey& key) const
    {
        uint64_t h = 0x9e3779b97f4a7c15u;
        for (const uint32_t k : key)
            h = (h ^ k) * 0xff51afd7ed558ccdu, h ^= h >> 32;
        return size_t(h);
    }
};

PositionKey positionKey(gpu::vec3 p) // adding 0 turns -0 into 0
{
    return {std::bit_cast<uint32_t>(p.x + 0.0f), std::bit_cast<uint32_t>(p.y + 0.0f),
            std::bit_cast<uint32_t>(p.z + 0.0f)};
}

/// The half-edge mesh of the welded triangles. A triangle that would make it non-manifold gets vertices of its own.
/// @param faces [triangle_count] the face of each triangle; invalid where the triangle is degenerate
Surface weldedSurface(const MeshPrimitive& mesh, std::vector<Surface::FaceHandle>& faces)
{
    [[maybe_unused]] static const bool quiet =
        (omerr().disable(), true); // it prints a line for every non-manifold edge
    Surface surface;
    std::unordered_map<PositionKey, Surface::VertexHandle, KeyHash> welded;
    std::vector<Surface::VertexHandle> vertices(mesh.positions.size());
    const auto point = [](gpu::vec3 p) { return Surface::Point(p.x, p.y, p.z); };
    for (size_t i = 0; i < mesh.positions.size(); ++i)
    {
        const auto [it, is_new] = welded.try_emplace(positionKey(mesh.positions[i]));
        if (is_new)
            it->second = surface.add_vertex(point(mesh.positions[i]));
        vertices[i] = it->second;
    }
    faces.reserve(mesh.triangles.size());
    for (const gpu::uvec3 t : mesh.triangles)
    {
        const auto a = vertices[t.x], b = vertices[t.y], c = vertices[t.z];
        if (a == b || b == c || c == a)
        {
            faces.push_back(Surface::InvalidFaceHandle);
            continue;
        }
        Surface::FaceHandle face = surface.add_face(a, b, c);
        if (!face.is_valid())
        {
            const std::array<Surface::Point, 3> corner{surface.point(a), surface.point(b), surface.point(c)}; // copies
            face = surface.add_face(surface.add_vertex(corner[0]), surface.add_vertex(corner[1]),
                                    surface.add_vertex(corner[2]));
        }
        faces.push_back(face);
    }
    return surface;
}
} // namespace

uint32_t duplicateVertex(MeshPrimitive& mesh, uint32_t v)
{
    const auto copy = [v](auto& array)
    {
        if (!array.empty())
            array.push_back(typename std::decay_t<decltype(array)>::value_type(array[v]));
    };
    copy(mesh.positions);
    copy(mesh.tangents);
    copy(mesh.uv0);
    copy(mesh.uv1);
    copy(mesh.colors);
    copy(mesh.sources);
    return uint32_t(mesh.positions.size() - 1);
}

uint64_t generateNormals(MeshPrimitive& mesh, float crease_angle)
{
    std::vector<Surface::FaceHandle> faces;
    Surface surface = weldedSurface(mesh, faces);
    surface.update_face_normals();
    surface.update_halfedge_normals(crease_angle);

    constexpr uint32_t kUnset = 0xffffffffu;
    const size_t source_count = mesh.positions.size();
    mesh.normals.assign(source_count, {0, 0, 0});
    std::vector<uint32_t> next(source_count, kUnset); // chain of a vertex's copies, one for each of its normals
    std::vector<bool> used(source_count, false);
    const auto vertexWithNormal = [&](uint32_t v, gpu::vec3 normal)
    {
        if (!used[v])
        {
            used[v] = true;
            mesh.normals[v] = normal;
            return v;
        }
        for (;; v = next[v])
        {
            if (dot(mesh.normals[v], normal) > 0.99999f)
                return v;
            if (next[v] == kUnset)
                break;
        }
        const uint32_t copy = duplicateVertex(mesh, v);
        next[v] = copy;
        next.push_back(kUnset);
        used.push_back(true);
        mesh.normals.push_back(normal);
        return copy;
    };
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
    {
        if (!faces[i].is_valid())
            continue;
        std::array<uint32_t*, 3> corner{&mesh.triangles[i].x, &mesh.triangles[i].y, &mesh.triangles[i].z};
        // The face's half-edges in order from the one that ends in the triangle's first corner.
        auto halfedge = surface.halfedge_handle(faces[i]);
        const auto at = [&](uint32_t v, Surface::HalfedgeHandle h)
        {
            const auto p = surface.point(surface.to_vertex_handle(h));
            return positionKey({float(p[0]), float(p[1]), float(p[2])}) == positionKey(mesh.positions[v]);
        };
        for (int turn = 0; turn < 2 && !at(*corner[0], halfedge); ++turn)
            halfedge = surface.next_halfedge_handle(halfedge);
        for (uint32_t* v : corner)
        {
            const auto n = surface.normal(halfedge);
            *v = vertexWithNormal(*v, directionOr({n[0], n[1], n[2]}, {0, 0, 0}));
            halfedge = surface.next_halfedge_handle(halfedge);
        }
    }
    return mesh.normals.size();
}
