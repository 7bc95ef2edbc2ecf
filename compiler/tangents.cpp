#include "compiler/tangents.h"

#include "compiler/linear.h"
#include "format/check.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <tuple>
#include <unordered_map>

namespace
{
constexpr uint32_t kUnset = 0xffffffffu;

/// Coordinates of vertex `v` in the map.
gpu::vec2 mapCoordinates(const MeshPrimitive& mesh, uint32_t v, const TextureUse& map)
{
    const std::vector<gpu::vec2>& source = (map.sampling & gpu::kSampleUv1) != 0 ? mesh.uv1 : mesh.uv0;
    if (v >= source.size())
        return {};
    const gpu::vec3 homogeneous{source[v].x, source[v].y, 1};
    return {dot(map.u_row, homogeneous), dot(map.v_row, homogeneous)};
}

/// Of a triangle in the map's coordinates.
struct MapEdges
{
    float du1, dv1, du2, dv2;

    float determinant() const { return du1 * dv2 - du2 * dv1; }
};

MapEdges mapEdges(const MeshPrimitive& mesh, gpu::uvec3 t, const TextureUse& map)
{
    const gpu::vec2 a = mapCoordinates(mesh, t.x, map);
    const gpu::vec2 b = mapCoordinates(mesh, t.y, map);
    const gpu::vec2 c = mapCoordinates(mesh, t.z, map);
    return {b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y};
}

/// The tangents of a mesh, which is read by the constructor alone. Corner 3 t + k is corner k of triangle t; edge 3 t +
/// k goes from there to the triangle's next corner.
class TangentSpace
{
public:
    TangentSpace(const MeshPrimitive& mesh, const TextureUse& map)
        : mesh_(mesh), corner_count_(3 * mesh.triangles.size()), places_(corner_count_),
          directions_(mesh.triangles.size()), signs_(mesh.triangles.size()), neighbours_(corner_count_, kUnset),
          groups_(corner_count_, kUnset)
    {
        weld(map);
        for (size_t t = 0; t < mesh.triangles.size(); ++t)
            orient(t, map);
        findNeighbours();
        for (uint32_t corner = 0; corner < corner_count_; ++corner)
            if (groups_[corner] == kUnset && isDrawn(corner / 3) && signs_[corner / 3] != 0)
                fillGroup(corner);
    }

    /// Of a corner: which corners have the same tangent. kUnset: the corner has none.
    uint32_t group(uint32_t corner) const { return groups_[corner]; }

    /// Unit and orthogonal to the normal, or 0.
    const Vec3d& tangent(uint32_t group) const { return tangents_[group]; }
    float sign(uint32_t group) const { return group_signs_[group]; }

private:
    using VertexKey = std::array<uint32_t, 8>; // position, normal, coordinates
    struct KeyHash
    {
        size_t operator()(const VertexKey& key) const
        {
            uint64_t h = 0x9e3779b97f4a7c15u;
            for (const uint32_t k : key)
                h = (h ^ k) * 0xff51afd7ed558ccdu, h ^= h >> 32;
            return size_t(h);
        }
    };

    uint32_t vertex(uint32_t corner) const { return (&mesh_.triangles[corner / 3].x)[corner % 3]; }
    static uint32_t next(uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
    static uint32_t previous(uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }
    Vec3d position(uint32_t corner) const { return toDouble(mesh_.positions[vertex(corner)]); }

    /// Whether a triangle's corners are in three places.
    bool isDrawn(size_t t) const
    {
        const auto c = uint32_t(3 * t);
        return position(c) != position(c + 1) && position(c + 1) != position(c + 2) && position(c + 2) != position(c);
    }

    /// Vertices that agree in all that tangents depend on are one place.
    void weld(const TextureUse& map)
    {
        std::unordered_map<VertexKey, uint32_t, KeyHash> places;
        std::vector<uint32_t> place_of(mesh_.positions.size());
        for (uint32_t v = 0; v < mesh_.positions.size(); ++v)
        {
            const gpu::vec3 p = mesh_.positions[v];
            const gpu::vec3 n = mesh_.normals[v];
            const gpu::vec2 c = mapCoordinates(mesh_, v, map);
            VertexKey key;
            size_t k = 0;
            for (const float f : {p.x, p.y, p.z, n.x, n.y, n.z, c.x, c.y})
                key[k++] = std::bit_cast<uint32_t>(f + 0.0f); // adding 0 turns -0 into 0
            place_of[v] = places.try_emplace(key, v).first->second;
        }
        for (uint32_t corner = 0; corner < corner_count_; ++corner)
            places_[corner] = place_of[vertex(corner)];
    }

    /// The direction of u in the triangle's plane, of any length, and which way round its coordinates go.
    void orient(size_t t, const TextureUse& map)
    {
        const MapEdges edges = mapEdges(mesh_, mesh_.triangles[t], map);
        const auto c = uint32_t(3 * t);
        const Vec3d e1 = position(c + 1) - position(c);
        const Vec3d e2 = position(c + 2) - position(c);
        directions_[t] = unitOrZero((e1 * edges.dv2 - e2 * edges.dv1) * (edges.determinant() < 0 ? -1 : 1));
        signs_[t] = handedness(mesh_, mesh_.triangles[t], map);
        if (signs_[t] == 0 || directions_[t] == Vec3d{})
        {
            signs_[t] = 0;
            directions_[t] = {};
        }
    }

    /// Pairs edges between the same two places that run in opposite directions, in the order of their triangles.
    void findNeighbours()
    {
        struct Edge
        {
            uint32_t low, high, corner;
            bool forward;
        };
        std::vector<Edge> edges;
        edges.reserve(corner_count_);
        for (uint32_t corner = 0; corner < corner_count_; ++corner)
            if (const uint32_t a = places_[corner], b = places_[next(corner)]; isDrawn(corner / 3))
                edges.push_back({std::min(a, b), std::max(a, b), corner, a < b});
        std::sort(edges.begin(), edges.end(),
                  [](const Edge& a, const Edge& b)
                  { return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner); });
        std::array<std::vector<uint32_t>, 2> waiting; // for their pair: corners of edges backward, forward
        std::array<size_t, 2> first{0, 0};
        for (size_t i = 0; i < edges.size(); ++i)
        {
            if (i == 0 || edges[i].low != edges[i - 1].low || edges[i].high != edges[i - 1].high)
            {
                waiting = {};
                first = {0, 0};
            }
            const size_t opposite = edges[i].forward ? 0 : 1;
            if (first[opposite] == waiting[opposite].size())
            {
                waiting[1 - opposite].push_back(edges[i].corner);
                continue;
            }
            const uint32_t pair = waiting[opposite][first[opposite]++];
            neighbours_[edges[i].corner] = pair;
            neighbours_[pair] = edges[i].corner;
        }
    }

    /// Takes `start` and the corners around its place that it is joined to into a new group. Triangles without
    /// coordinates belong to whichever group reaches them first.
    void fillGroup(uint32_t start)
    {
        const auto group = uint32_t(tangents_.size());
        const float sign = signs_[start / 3];
        std::vector<uint32_t> members;
        std::vector<uint32_t> pending{start};
        while (!pending.empty())
        {
            const uint32_t corner = pending.back();
            pending.pop_back();
            const uint32_t t = corner / 3;
            if (groups_[corner] != kUnset || (directions_[t] != Vec3d{} && signs_[t] != sign))
                continue;
            if (signs_[t] == 0)
                signs_[t] = sign;
            if (signs_[t] != sign)
                continue;
            groups_[corner] = group;
            members.push_back(corner);
            // Across the edge that leaves here the neighbour's edge ends here, and the other way round.
            if (const uint32_t edge = neighbours_[corner]; edge != kUnset)
                pending.push_back(next(edge));
            if (const uint32_t edge = neighbours_[previous(corner)]; edge != kUnset)
                pending.push_back(edge);
        }
        tangents_.push_back(mean(members));
        group_signs_.push_back(sign);
    }

    /// The mean of the members' directions in the plane of their normal, weighted by the angles there.
    Vec3d mean(std::span<const uint32_t> members) const
    {
        const Vec3d normal = unitOrZero(toDouble(mesh_.normals[vertex(members[0])]));
        const auto inPlane = [&](const Vec3d& v) { return unitOrZero(v - normal * dot(normal, v)); };
        Vec3d sum;
        for (const uint32_t corner : members)
        {
            const Vec3d a = inPlane(position(previous(corner)) - position(corner));
            const Vec3d b = inPlane(position(next(corner)) - position(corner));
            const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0));
            sum = sum + inPlane(directions_[corner / 3]) * angle;
        }
        return inPlane(sum);
    }

    const MeshPrimitive& mesh_;
    const uint32_t corner_count_;
    std::vector<uint32_t> places_;     // [corner]
    std::vector<Vec3d> directions_;    // [triangle] unit, 0 where the coordinates have no area
    std::vector<float> signs_;         // [triangle] of the glTF tangent, 0 until a group has it
    std::vector<uint32_t> neighbours_; // [edge] the other triangle's edge, kUnset: there is none
    std::vector<uint32_t> groups_;     // [corner]
    std::vector<Vec3d> tangents_;      // [group]
    std::vector<float> group_signs_;   // [group]
};
} // namespace

float handedness(const MeshPrimitive& mesh, gpu::uvec3 t, const TextureUse& map)
{
    // cross(normal, tangent) * w must point up in the image, towards -v: a quad with u to its right and v down has w
    // = 1.
    const float determinant = mapEdges(mesh, t, map).determinant();
    return determinant < 0 ? 1.0f : determinant > 0 ? -1.0f : 0.0f;
}

uint64_t generateTangents(MeshPrimitive& mesh, const TextureUse& map)
{
    check(mesh.normals.size() == mesh.positions.size(), "{} normals", mesh.normals.size());
    const TangentSpace space(mesh, map);
    mesh.tangents.assign(mesh.positions.size(), {});
    std::vector<uint32_t> groups(mesh.positions.size(), kUnset); // [vertex] that its tangent is of, kUnset: none yet
    std::vector<uint32_t> copies(mesh.positions.size(), kUnset); // [vertex] its next copy, for another group
    const auto vertexOfGroup = [&](uint32_t v, uint32_t group)
    {
        while (groups[v] != kUnset && groups[v] != group && copies[v] != kUnset)
            v = copies[v];
        if (groups[v] == kUnset || groups[v] == group)
            return v;
        const uint32_t copy = duplicateVertex(mesh, v);
        mesh.normals.push_back(gpu::vec3(mesh.normals[v]));
        groups.push_back(kUnset);
        copies.push_back(kUnset);
        copies[v] = copy;
        return copy;
    };
    for (uint32_t corner = 0; corner < 3 * mesh.triangles.size(); ++corner)
    {
        const uint32_t group = space.group(corner);
        if (group == kUnset)
            continue;
        uint32_t& v = (&mesh.triangles[corner / 3].x)[corner % 3];
        v = vertexOfGroup(v, group);
        groups[v] = group;
        const gpu::vec3 t = directionOr(space.tangent(group), anyOrthogonal(mesh.normals[v]));
        mesh.tangents[v] = {t.x, t.y, t.z, space.sign(group)};
    }
    for (size_t v = 0; v < mesh.tangents.size(); ++v)
        if (groups[v] == kUnset)
        {
            const gpu::vec3 t = anyOrthogonal(mesh.normals[v]);
            mesh.tangents[v] = {t.x, t.y, t.z, 1};
        }
    return mesh.tangents.size();
}
