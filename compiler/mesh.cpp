#include "compiler/mesh.h"

#include "compiler/encode.h"
#include "compiler/linear.h"
#include "format/check.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <array>
#include <bit>
#include <cstring>
#include <unordered_map>

namespace
{
struct SurfaceTraits : OpenMesh::DefaultTraits
{
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

/// Appends a copy of vertex `v` of every array but the normals.
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
    return uint32_t(mesh.positions.size() - 1);
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

/// Area-weighted tangent and its handedness in one triangle; handedness 0 where the coordinates are degenerate.
struct TriangleTangent
{
    gpu::vec3 direction{};
    float handedness = 0;
};

TriangleTangent triangleTangent(const MeshPrimitive& mesh, gpu::uvec3 t, const std::vector<gpu::vec2>& uv)
{
    const gpu::vec3 e1 = mesh.positions[t.y] - mesh.positions[t.x];
    const gpu::vec3 e2 = mesh.positions[t.z] - mesh.positions[t.x];
    const float du1 = uv[t.y].x - uv[t.x].x, dv1 = uv[t.y].y - uv[t.x].y;
    const float du2 = uv[t.z].x - uv[t.x].x, dv2 = uv[t.z].y - uv[t.x].y;
    const float det = du1 * dv2 - du2 * dv1;
    const gpu::vec3 along_u = normalizeOr((e1 * dv2 - e2 * dv1) * (det < 0 ? -1.0f : 1.0f), {});
    if (!(std::fabs(det) > 0) || dot(along_u, along_u) == 0)
        return {};
    // cross(normal, tangent) * w must point up in the image, towards -v: a quad with u to its right and v down has w
    // = 1.
    return {along_u * length(cross(e1, e2)), det < 0 ? 1.0f : -1.0f};
}
} // namespace

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
            return positionKey({p[0], p[1], p[2]}) == positionKey(mesh.positions[v]);
        };
        for (int turn = 0; turn < 2 && !at(*corner[0], halfedge); ++turn)
            halfedge = surface.next_halfedge_handle(halfedge);
        for (uint32_t* v : corner)
        {
            const auto n = surface.normal(halfedge);
            *v = vertexWithNormal(*v, normalizeOr({n[0], n[1], n[2]}, {0, 0, 0}));
            halfedge = surface.next_halfedge_handle(halfedge);
        }
    }
    return mesh.normals.size();
}

uint64_t generateTangents(MeshPrimitive& mesh, const TextureUse& normal_map)
{
    check(mesh.normals.size() == mesh.positions.size(), "{} normals", mesh.normals.size());
    const std::vector<gpu::vec2>& source = (normal_map.sampling & gpu::kSampleUv1) != 0 ? mesh.uv1 : mesh.uv0;
    std::vector<gpu::vec2> uv(mesh.positions.size());
    for (size_t i = 0; i < source.size(); ++i)
        uv[i] = {dot(normal_map.u_row, {source[i].x, source[i].y, 1}),
                 dot(normal_map.v_row, {source[i].x, source[i].y, 1})};

    const size_t source_count = mesh.positions.size();
    std::vector<gpu::vec3> sums(source_count, gpu::vec3{});
    std::vector<float> handedness(source_count, 0);
    std::vector<uint32_t> mirrored(source_count, 0); // a vertex's copy of the other handedness, 0: none
    const auto add = [&](uint32_t v, const TriangleTangent& t)
    {
        if (handedness[v] != 0 && handedness[v] != t.handedness)
        {
            if (mirrored[v] == 0)
            {
                mirrored[v] = duplicateVertex(mesh, v);
                mesh.normals.push_back(gpu::vec3(mesh.normals[v]));
                sums.push_back({});
                handedness.push_back(t.handedness);
            }
            v = mirrored[v];
        }
        handedness[v] = t.handedness;
        sums[v] = sums[v] + t.direction;
        return v;
    };
    for (gpu::uvec3& t : mesh.triangles)
        if (const TriangleTangent tangent = triangleTangent(mesh, t, uv); tangent.handedness != 0)
            t = {add(t.x, tangent), add(t.y, tangent), add(t.z, tangent)};

    mesh.tangents.resize(mesh.positions.size());
    for (size_t i = 0; i < mesh.tangents.size(); ++i)
    {
        const gpu::vec3 n = mesh.normals[i];
        const gpu::vec3 t = normalizeOr(sums[i] - n * dot(n, sums[i]), anyOrthogonal(n));
        mesh.tangents[i] = {t.x, t.y, t.z, handedness[i] == 0 ? 1.0f : handedness[i]};
    }
    return mesh.tangents.size();
}
