#include "compiler/caustic_targets.h"

#include "compiler/bvh_tree.h"
#include "compiler/vector_math.h"

#include <algorithm>
#include <span>

namespace
{
constexpr float kSmooth = 0.1f; // perceptual roughness up to which a surface focuses light

bool isSpecular(const gpu::Material& m)
{
    if (m.roughness >= kSmooth || (m.flags & gpu::kMaterialUnlit) != 0)
        return false;
    const bool glass = m.transmission > 0 && (m.flags & gpu::kMaterialThin) == 0;
    const bool metal = m.metallic > 0.5f && m.metallic_roughness_texture == gpu::kNone;
    return glass || metal;
}

gpu::CausticTarget merge(std::span<const gpu::CausticTarget> targets)
{
    Box box;
    for (const gpu::CausticTarget& t : targets)
    {
        const gpu::vec3 r{t.radius, t.radius, t.radius};
        box.grow(t.center - r);
        box.grow(t.center + r);
    }
    gpu::CausticTarget merged{(box.low + box.high) * 0.5f, 0};
    for (const gpu::CausticTarget& t : targets)
        merged.radius = std::max(merged.radius, length(t.center - merged.center) + t.radius);
    return merged;
}

/// Replaces `targets` by at most `budget` spheres around neighbours.
void reduce(std::span<gpu::CausticTarget> targets, size_t budget, std::vector<gpu::CausticTarget>& out)
{
    if (targets.size() <= budget)
        return void(out.insert(out.end(), targets.begin(), targets.end()));
    if (budget == 1)
        return out.push_back(merge(targets));
    Box centers;
    for (const gpu::CausticTarget& t : targets)
        centers.grow(t.center);
    const gpu::vec3 size = centers.high - centers.low;
    const auto coordinate = [&](const gpu::CausticTarget& t) {
        return size.x >= size.y && size.x >= size.z ? t.center.x : size.y >= size.z ? t.center.y : t.center.z;
    };
    std::stable_sort(targets.begin(), targets.end(),
                     [&](const gpu::CausticTarget& a, const gpu::CausticTarget& b)
                     { return coordinate(a) < coordinate(b); });
    const size_t half = targets.size() / 2;
    reduce(targets.first(half), budget / 2, out);
    reduce(targets.subspan(half), budget - budget / 2, out);
}
} // namespace

CausticTargets findCausticTargets(const SceneData& scene)
{
    const WorldMesh& mesh = scene.mesh;
    const auto forEachCorner = [&](const auto& visit)
    {
        for (size_t i = 0; i < mesh.triangles.size(); ++i)
        {
            if (!isSpecular(scene.materials[mesh.materials[i]]))
                continue;
            for (const uint32_t v : {mesh.triangles[i].x, mesh.triangles[i].y, mesh.triangles[i].z})
                visit(mesh.objects[i], mesh.positions[v]);
        }
    };
    std::vector<Box> boxes(mesh.object_count);
    forEachCorner([&](uint32_t object, const gpu::vec3& p) { boxes[object].grow(p); });
    std::vector<gpu::CausticTarget> spheres;
    for (const Box& box : boxes)
        spheres.push_back({(box.low + box.high) * 0.5f, 0});
    forEachCorner([&](uint32_t object, const gpu::vec3& p)
                  { spheres[object].radius = std::max(spheres[object].radius, length(p - spheres[object].center)); });

    const uint32_t first_moving = mesh.moving.empty() ? mesh.object_count : mesh.objects[mesh.moving.front()];
    CausticTargets targets{.spheres = {}, .of_object = std::vector<int>(mesh.object_count, -1)};
    std::vector<gpu::CausticTarget> fixed, moving;
    for (uint32_t object = 0; object < mesh.object_count; ++object)
        if (spheres[object].radius > 0)
            (object < first_moving ? fixed : moving).push_back(spheres[object]);
    if (moving.size() > kMaxMovingTargets)
    {
        fixed.insert(fixed.end(), moving.begin(), moving.end());
        moving.clear();
    }
    reduce(fixed, kMaxCausticTargets - moving.size(), targets.spheres);
    auto next = int(targets.spheres.size());
    targets.spheres.insert(targets.spheres.end(), moving.begin(), moving.end());
    for (uint32_t object = first_moving; object < mesh.object_count && !moving.empty(); ++object)
        if (spheres[object].radius > 0)
            targets.of_object[object] = next++;
    return targets;
}
