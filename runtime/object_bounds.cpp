#include "runtime/object_bounds.h"

#include <algorithm>
#include <cmath>

namespace
{
std::array<float, 3> toArray(const gpu::vec3& v)
{
    return {v.x, v.y, v.z};
}

bool isHidden(const gpu::BoneMatrix& m)
{
    const auto isZero = [](const gpu::vec4& row) { return row.x == 0 && row.y == 0 && row.z == 0 && row.w == 0; };
    return isZero(m.x) && isZero(m.y) && isZero(m.z);
}
} // namespace

ObjectBounds::ObjectBounds(const package::Package& package)
{
    const auto vertices = package.movingVertices();
    const auto influences = package.influences();
    const auto morphs = package.morphOffsets();
    std::vector<uint32_t> part_of(package.motion()->bones()->size(), gpu::kNone); // of the object at hand
    for (const package::MovingRange& object : package.movingRanges())
    {
        const size_t first_part = parts_.size();
        const uint32_t first = object.first_vertex - package.firstMovingVertex();
        for (uint32_t v = first; v < first + object.vertex_count; ++v)
        {
            const bool last = v + 1 == vertices.size();
            const size_t influence_end = last ? influences.size() : vertices[v + 1].first_influence;
            const size_t morph_end = last ? morphs.size() : vertices[v + 1].first_morph;
            for (size_t i = vertices[v].first_influence; i < influence_end; ++i)
            {
                if (influences[i].weight == 0)
                    continue;
                uint32_t& part = part_of[influences[i].bone];
                if (part == gpu::kNone)
                {
                    part = uint32_t(parts_.size());
                    parts_.push_back({.bone = influences[i].bone, .box = {}, .morphs = {}});
                }
                const std::array<float, 3> at = toArray(vertices[v].position);
                parts_[part].box.grow({at, at});
                for (size_t m = vertices[v].first_morph; m < morph_end; ++m)
                    addMorph(parts_[part], morphs[m]);
            }
        }
        for (size_t part = first_part; part < parts_.size(); ++part)
            part_of[parts_[part].bone] = gpu::kNone;
        part_end_.push_back(uint32_t(parts_.size()));
    }
    boxes_.resize(part_end_.size());
}

void ObjectBounds::addMorph(Part& part, const gpu::MorphOffset& offset)
{
    auto morph = std::ranges::find(part.morphs, offset.weight, &Morph::weight);
    if (morph == part.morphs.end())
        morph = part.morphs.insert(part.morphs.end(), {.weight = offset.weight});
    const std::array<float, 3> by = toArray(offset.position);
    for (size_t axis = 0; axis < 3; ++axis)
    {
        morph->low[axis] = std::min(morph->low[axis], by[axis]);
        morph->high[axis] = std::max(morph->high[axis], by[axis]);
    }
}

ObjectBox ObjectBounds::boxAt(const Part& part, const package::Pose& pose)
{
    const gpu::BoneMatrix& m = pose.bones[part.bone];
    if (isHidden(m))
        return {};
    std::array<float, 3> center, half;
    for (size_t axis = 0; axis < 3; ++axis)
    {
        float low = part.box.low[axis], high = part.box.high[axis];
        for (const Morph& morph : part.morphs)
        {
            const float weight = pose.weights[morph.weight];
            low += std::min(weight * morph.low[axis], weight * morph.high[axis]);
            high += std::max(weight * morph.low[axis], weight * morph.high[axis]);
        }
        center[axis] = 0.5f * low + 0.5f * high;
        half[axis] = 0.5f * high - 0.5f * low;
    }
    ObjectBox box;
    for (size_t axis = 0; axis < 3; ++axis)
    {
        const gpu::vec4& row = axis == 0 ? m.x : axis == 1 ? m.y : m.z;
        const float at = row.x * center[0] + row.y * center[1] + row.z * center[2] + row.w;
        const float reach = std::abs(row.x) * half[0] + std::abs(row.y) * half[1] + std::abs(row.z) * half[2];
        box.low[axis] = at - reach;
        box.high[axis] = at + reach;
        if (!std::isfinite(box.low[axis]) || !std::isfinite(box.high[axis]))
            return {};
    }
    return box;
}

std::span<const ObjectBox> ObjectBounds::at(const package::Pose& pose)
{
    uint32_t part = 0;
    for (size_t object = 0; object < boxes_.size(); ++object)
    {
        boxes_[object] = {};
        for (; part < part_end_[object]; ++part)
            boxes_[object].grow(boxAt(parts_[part], pose));
    }
    return boxes_;
}
