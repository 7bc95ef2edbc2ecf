#include "compiler/moving_vertex.h"

#include "compiler/linear.h"

namespace
{
/// The normal of the triangle in the mesh's space that becomes its facing in the world's.
Vec3d localFacing(const MovingCorner& corner)
{
    const auto at = [&](uint32_t v) { return toDouble(corner.moving.positions[v]); };
    const gpu::uvec3& t = corner.triangle;
    return unitOrZero(cross(at(t.y) - at(t.x), at(t.z) - at(t.x))) * (corner.mirrored ? -1 : 1);
}

gpu::vec3 localNormal(const MovingCorner& corner)
{
    const Vec3d normal = toDouble(corner.moving.normals[corner.vertex]) * (corner.flipped ? -1 : 1);
    return directionOr(normal, directionOr(localFacing(corner), {0, 1, 0}));
}

gpu::vec4 localTangent(const MovingCorner& corner, gpu::vec3 normal)
{
    const float sign = corner.negative_bitangent ? -1.0f : 1.0f;
    if (corner.moving.tangents.empty())
        return {0, 0, 0, sign};
    const gpu::vec4& t = corner.moving.tangents[corner.vertex];
    const gpu::vec3 along = directionOr(Vec3d{t.x, t.y, t.z}, anyOrthogonal(normal));
    return {along.x, along.y, along.z, sign};
}

void appendInfluences(const MovingCorner& corner, const MovingPlace& place, std::vector<gpu::Influence>& out)
{
    const Influences& influences = corner.moving.influences;
    if (influences.per_vertex == 0)
        return out.push_back({place.node_bone, 1});
    const size_t first = size_t(corner.moving.sources[corner.vertex]) * influences.per_vertex;
    for (size_t k = first; k < first + influences.per_vertex; ++k)
        if (influences.weights[k] > 0)
            out.push_back({place.first_bone + influences.joints[k], influences.weights[k]});
}

void appendMorphs(const MovingCorner& corner, const MovingPlace& place, std::vector<gpu::MorphOffset>& out)
{
    const uint32_t source = corner.moving.sources[corner.vertex];
    const auto of = [source](const std::vector<gpu::vec3>& offsets) {
        return offsets.empty() ? gpu::vec3{0, 0, 0} : offsets[source];
    };
    const auto isZero = [](const gpu::vec3& v) { return v.x == 0 && v.y == 0 && v.z == 0; };
    for (uint32_t t = 0; t < corner.moving.targets.size(); ++t)
    {
        const MorphTarget& target = corner.moving.targets[t];
        gpu::vec3 normal = of(target.normals);
        if (corner.flipped)
            normal = normal * -1.0f;
        const gpu::MorphOffset offset{of(target.positions), place.first_weight + t, normal, of(target.tangents)};
        if (!isZero(offset.position) || !isZero(offset.normal) || !isZero(offset.tangent))
            out.push_back(offset);
    }
}
} // namespace

void appendMovingVertex(const MovingCorner& corner, const MovingPlace& place, MotionData& motion)
{
    const gpu::vec3 normal = localNormal(corner);
    motion.vertices.push_back({.position = corner.moving.positions[corner.vertex],
                               .first_influence = uint32_t(motion.influences.size()),
                               .normal = normal,
                               .first_morph = uint32_t(motion.morph_offsets.size()),
                               .tangent = localTangent(corner, normal)});
    appendInfluences(corner, place, motion.influences);
    appendMorphs(corner, place, motion.morph_offsets);
}
