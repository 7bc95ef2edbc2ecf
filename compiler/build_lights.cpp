#include "compiler/build_lights.h"

#include "compiler/caustic_targets.h"
#include "compiler/emission_average.h"
#include "compiler/environment.h"
#include "compiler/vector_math.h"
#include "format/light_table.h"
#include "format/spot_cone.h"

#include <algorithm>
#include <numeric>

namespace
{
namespace fb = lumicut::fb;

struct Candidate
{
    gpu::Light light;
    gpu::vec3 yield{1, 1, 1};
    bool keep = false;              // where it has no power, too
    uint32_t punctual = gpu::kNone; // its number in the scene
    double power = 0;               // W, luminance
};

package::LightSurroundings surroundingsOf(const SceneData& scene)
{
    package::LightSurroundings around;
    if (!scene.mesh.positions.empty())
    {
        gpu::vec3 low = scene.mesh.positions[0];
        gpu::vec3 high = low;
        for (const gpu::vec3& p : scene.mesh.positions)
        {
            low = min(low, p);
            high = max(high, p);
        }
        around.radius = package::sphereRadius(low, high);
    }
    if (scene.environment)
        around.average_radiance = averageRadiance(*scene.environment);
    return around;
}

/// Materials that an animation can change in some way.
struct AnimatedMaterials
{
    std::vector<bool> may_emit; // by material: at some time, whatever it is at rest
    std::vector<bool> alpha;    // by material
};

AnimatedMaterials animatedMaterials(const SceneData& scene)
{
    AnimatedMaterials result{.may_emit = std::vector<bool>(scene.materials.size()),
                             .alpha = std::vector<bool>(scene.materials.size())};
    if (!scene.motion)
        return result;
    for (const auto& clip : scene.motion->tables.clips)
        for (const auto& channel : clip->channels)
        {
            if (channel->target == fb::ChannelTarget::MaterialBaseColor)
                result.alpha[channel->index] = true;
            else if (channel->target == fb::ChannelTarget::MaterialEmissive ||
                     channel->target == fb::ChannelTarget::MaterialEmissiveStrength)
                result.may_emit[channel->index] = result.may_emit[channel->index] ||
                                                  std::ranges::any_of(channel->values, [](float v) { return v != 0; });
        }
    return result;
}

gpu::Light punctual(const PunctualLight& source)
{
    return {.p0 = toFloat(source.position),
            .kind = source.kind,
            .p1 = source.direction,
            .triangle = gpu::kNone,
            .p2 =
                source.kind == gpu::kLightSpot ? package::spotCone(source.inner_cone, source.outer_cone) : gpu::vec3{},
            .pmf = 0,
            .emission = source.intensity,
            .material = gpu::kNone};
}

/// @param any_alpha its material's alpha is animated: what of it counts cannot be said
Candidate emissiveTriangle(const SceneData& scene, uint32_t triangle, bool any_alpha)
{
    const uint32_t material_index = scene.mesh.materials[triangle];
    const gpu::Material& material = scene.materials[material_index];
    const gpu::uvec3& v = scene.mesh.triangles[triangle];
    const bool textured = material.emissive_texture != gpu::kNone;
    const bool two_sided = (material.flags & gpu::kMaterialDoubleSided) != 0;
    const bool masked = (material.flags & gpu::kMaterialAlphaMask) != 0;
    const bool blended = (material.flags & gpu::kMaterialAlphaBlend) != 0;

    gpu::vec3 yield = textured ? averageEmissiveTexture(scene, triangle) : gpu::vec3{1, 1, 1};
    if (blended && !any_alpha)
        yield = yield * material.alpha; // textures may take more away
    if (masked && !any_alpha && material.alpha < material.alpha_cutoff)
        yield = {}; // nothing is there
    return {.light = {.p0 = scene.mesh.positions[v.x],
                      .kind = two_sided ? gpu::kLightTriangleTwoSided : gpu::kLightTriangle,
                      .p1 = scene.mesh.positions[v.y],
                      .triangle = triangle,
                      .p2 = scene.mesh.positions[v.z],
                      .pmf = 0,
                      .emission = material.emission,
                      .material = textured || masked || blended ? material_index : gpu::kNone},
            .yield = yield};
}

std::vector<Candidate> collect(const SceneData& scene)
{
    std::vector<Candidate> candidates;
    for (const PunctualLight& light : scene.lights)
        candidates.push_back({.light = punctual(light), .keep = light.moves, .punctual = uint32_t(candidates.size())});
    const AnimatedMaterials animated = animatedMaterials(scene);
    for (uint32_t i = 0; i < scene.mesh.triangles.size(); ++i)
    {
        const uint32_t index = scene.mesh.materials[i];
        const gpu::Material& material = scene.materials[index];
        const bool emits = luminance(material.emission) > 0;
        if ((material.flags & gpu::kMaterialUnlit) != 0 || !(emits || animated.may_emit[index]))
            continue;
        Candidate candidate = emissiveTriangle(scene, i, animated.alpha[index]);
        const bool black = luminance(candidate.yield) == 0; // whatever its emission
        candidate.keep = !black && (animated.may_emit[index] || i >= scene.mesh.staticTriangleCount());
        candidates.push_back(candidate);
    }
    if (scene.environment)
        candidates.push_back({.light = {.p0 = {},
                                        .kind = gpu::kLightEnvironment,
                                        .p1 = {},
                                        .triangle = gpu::kNone,
                                        .p2 = {},
                                        .pmf = 0,
                                        .emission = {1, 1, 1},
                                        .material = gpu::kNone}});
    const package::LightSurroundings around = surroundingsOf(scene);
    for (Candidate& candidate : candidates)
        candidate.power = package::lightPower(candidate.light, candidate.yield, around);
    return candidates;
}

double totalPower(const std::vector<Candidate>& candidates)
{
    return std::accumulate(candidates.begin(), candidates.end(), 0.0,
                           [](double sum, const Candidate& c) { return sum + c.power; });
}
} // namespace

LightTables buildLights(const SceneData& scene)
{
    LightTables tables;
    CausticTargets targets = findCausticTargets(scene);
    tables.caustic_targets = std::move(targets.spheres);
    tables.caustic_target_of = std::move(targets.of_object);
    tables.of_punctual.assign(scene.lights.size(), gpu::kNone);

    std::vector<Candidate> candidates = collect(scene);
    const double least = totalPower(candidates) * package::kLeastPowerShare;
    std::erase_if(candidates, [&](const Candidate& c) { return !(c.power > least) && !c.keep; });
    tables.total_power = float(totalPower(candidates));
    std::vector<gpu::Light> lights;
    for (uint32_t i = 0; i < candidates.size(); ++i)
    {
        const Candidate& c = candidates[i];
        if (c.punctual != gpu::kNone)
            tables.of_punctual[c.punctual] = i;
        tables.emissive_triangles += c.light.triangle != gpu::kNone ? 1 : 0;
        tables.powers.push_back(float(c.power));
        tables.yields.push_back(c.yield);
        lights.push_back(c.light);
    }
    package::LightTable table(std::move(lights), tables.yields, surroundingsOf(scene));
    table.rebuild();
    tables.lights.assign(table.lights().begin(), table.lights().end());
    tables.aliases.assign(table.aliases().begin(), table.aliases().end());
    if (std::ranges::all_of(tables.yields, [](gpu::vec3 y) { return y.x == 1 && y.y == 1 && y.z == 1; }))
        tables.yields.clear();
    return tables;
}
