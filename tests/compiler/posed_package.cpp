#include "tests/compiler/posed_package.h"

#include <algorithm>
#include <limits>

namespace
{
double dot4(const gpu::vec4& row, const Vec3d& p)
{
    return row.x * p.x + row.y * p.y + row.z * p.z + row.w;
}

double difference(const Corners& a, const Corners& b, size_t turn)
{
    double most = 0;
    for (size_t i = 0; i < 3; ++i)
        most = std::max(most, length(a[i] - b[(i + turn) % 3]));
    return most;
}

bool hasArea(const Corners& t)
{
    const Vec3d u = t[1] - t[0], v = t[2] - t[0];
    return length(cross(u, v)) > 1e-6 * std::max(dot(u, u), dot(v, v));
}

double farthestFrom(const std::vector<Corners>& a, const std::vector<Corners>& b)
{
    double farthest = 0;
    for (size_t i = 0; i < a.size(); ++i)
    {
        const Corners& t = a[i];
        if (!hasArea(t))
            continue;
        // Most have the same number in both: then there is no need to look for a nearer one.
        double nearest = i < b.size() ? difference(t, b[i], 0) : std::numeric_limits<double>::infinity();
        if (nearest <= farthest)
            continue;
        for (const Corners& other : b)
            for (size_t turn = 0; turn < 3; ++turn)
                nearest = std::min(nearest, difference(t, other, turn));
        farthest = std::max(farthest, nearest);
    }
    return farthest;
}
} // namespace

std::vector<Vec3d> movedVertices(const package::Package& package, const package::Pose& pose)
{
    const auto vertices = package.movingVertices();
    std::vector<Vec3d> moved;
    for (size_t i = 0; i < vertices.size(); ++i)
    {
        const bool last = i + 1 == vertices.size();
        const size_t influences_end = last ? package.influences().size() : vertices[i + 1].first_influence;
        const size_t morphs_end = last ? package.morphOffsets().size() : vertices[i + 1].first_morph;
        Vec3d local = toDouble(vertices[i].position);
        for (size_t k = vertices[i].first_morph; k < morphs_end; ++k)
        {
            const gpu::MorphOffset& offset = package.morphOffsets()[k];
            local = local + toDouble(offset.position) * pose.weights[offset.weight];
        }
        Vec3d sum;
        for (size_t k = vertices[i].first_influence; k < influences_end; ++k)
        {
            const gpu::Influence& influence = package.influences()[k];
            const gpu::BoneMatrix& bone = pose.bones[influence.bone];
            sum = sum + Vec3d{dot4(bone.x, local), dot4(bone.y, local), dot4(bone.z, local)} * influence.weight;
        }
        moved.push_back(sum);
    }
    return moved;
}

std::vector<Vec3d> restVertices(const package::Package& package)
{
    std::vector<Vec3d> positions(package.vertexAttributes().size());
    for (const gpu::BvhTriangle& t : package.bvhTriangles())
    {
        const gpu::uvec3& v = package.triangles()[t.triangle].vertices;
        positions[v.x] = toDouble(t.v0);
        positions[v.y] = toDouble(t.v1);
        positions[v.z] = toDouble(t.v2);
    }
    return positions;
}

std::vector<Corners> trianglesOver(const package::Package& package, const std::vector<Vec3d>& positions)
{
    const lumicut::fb::Vec3d* const o = package.meta().origin();
    const Vec3d origin = o == nullptr ? Vec3d{} : Vec3d{o->x(), o->y(), o->z()};
    const auto at = [&](uint32_t v) { return origin + positions[v] * package.meta().unit(); };
    std::vector<Corners> triangles;
    for (const gpu::Triangle& t : package.triangles())
        triangles.push_back({at(t.vertices.x), at(t.vertices.y), at(t.vertices.z)});
    return triangles;
}

double farthestCorner(const std::vector<Corners>& a, const std::vector<Corners>& b)
{
    return std::max(farthestFrom(a, b), farthestFrom(b, a));
}
