#include "runtime/stages/emitter_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace
{
/// The bone that alone moves these vertices, without morphs.
std::optional<uint32_t> onlyBone(const package::Package& package, uint32_t first, uint32_t count)
{
    const auto vertices = package.movingVertices();
    std::optional<uint32_t> bone;
    for (uint32_t i = first; i < first + count; ++i)
    {
        const bool last = i + 1 == vertices.size();
        const size_t influences_end = last ? package.influences().size() : vertices[i + 1].first_influence;
        const size_t morphs_end = last ? package.morphOffsets().size() : vertices[i + 1].first_morph;
        if (influences_end != vertices[i].first_influence + 1u || morphs_end != vertices[i].first_morph)
            return std::nullopt;
        const gpu::Influence& influence = package.influences()[vertices[i].first_influence];
        if (influence.weight != 1 || (bone && *bone != influence.bone))
            return std::nullopt;
        bone = influence.bone;
    }
    return bone;
}
} // namespace

void LightChanges::restart(std::span<const gpu::Light> lights)
{
    for (const ChangedLight& light : changed_)
        places_[light.index] = gpu::kNone;
    changed_.clear();
    places_.resize(lights.size(), gpu::kNone);
    lights_ = lights;
}

gpu::Light& LightChanges::of(uint32_t index)
{
    if (places_[index] == gpu::kNone)
    {
        places_[index] = uint32_t(changed_.size());
        changed_.push_back({index, lights_[index]});
    }
    return changed_[places_[index]].light;
}

EmitterShapes::EmitterShapes(const package::Package& package) : package_(package)
{
    const uint32_t first_vertex = package.firstMovingVertex();
    const package::Pose rest = package::poseAtRest(package);
    for (const package::MovingRange& range : package.movingRanges())
    {
        Object object;
        for (uint32_t i = range.first_triangle; i < range.first_triangle + range.triangle_count; ++i)
        {
            const gpu::Triangle& t = package.triangles()[i];
            if (t.light != gpu::kNone)
                object.triangles.push_back(
                    {t.light, {t.vertices.x - first_vertex, t.vertices.y - first_vertex, t.vertices.z - first_vertex}});
        }
        if (object.triangles.empty())
            continue;
        object.bone = onlyBone(package, range.first_vertex - first_vertex, range.vertex_count);
        if (object.bone)
            object.rest = stretchOf(rest.bones[*object.bone]);
        objects_.push_back(std::move(object));
    }
}

EmitterShapes::Stretch EmitterShapes::stretchOf(const gpu::BoneMatrix& m)
{
    return {.xx = m.x.x * m.x.x + m.y.x * m.y.x + m.z.x * m.z.x,
            .yy = m.x.y * m.x.y + m.y.y * m.y.y + m.z.y * m.z.y,
            .zz = m.x.z * m.x.z + m.y.z * m.y.z + m.z.z * m.z.z,
            .xy = m.x.x * m.x.y + m.y.x * m.y.y + m.z.x * m.z.y,
            .xz = m.x.x * m.x.z + m.y.x * m.y.z + m.z.x * m.z.z,
            .yz = m.x.y * m.x.z + m.y.y * m.y.z + m.z.y * m.z.z};
}

bool EmitterShapes::isAlike(const Stretch& a, const Stretch& b)
{
    constexpr float kSame = 1e-4f; // of the largest: far above rounding, and nothing to the choice of lights
    const float largest = std::max({a.xx, a.yy, a.zz});
    return std::ranges::all_of(std::array{a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz},
                               [&](float difference) { return std::fabs(difference) <= kSame * largest; });
}

void EmitterShapes::change(const package::Pose& pose, LightChanges& changes)
{
    for (Object& object : objects_)
    {
        const bool as_in_package = object.bone && isAlike(object.rest, stretchOf(pose.bones[*object.bone]));
        if (as_in_package && object.as_in_package)
            continue;
        object.as_in_package = as_in_package;
        for (const Triangle& triangle : object.triangles)
        {
            gpu::Light& light = changes.of(triangle.light);
            if (as_in_package)
            {
                const gpu::Light& at_rest = package_.lights()[triangle.light];
                light.p0 = at_rest.p0;
                light.p1 = at_rest.p1;
                light.p2 = at_rest.p2;
                continue;
            }
            light.p0 = package::posedPosition(package_, pose, triangle.vertices.x);
            light.p1 = package::posedPosition(package_, pose, triangle.vertices.y);
            light.p2 = package::posedPosition(package_, pose, triangle.vertices.z);
        }
    }
}
