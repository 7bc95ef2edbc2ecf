#include "compiler/build_lights.h"

#include "compiler/caustic_targets.h"
#include "compiler/emission_average.h"
#include "compiler/environment.h"
#include "compiler/vector_math.h"
#include "format/alias_table.h"
#include "format/spot_cone.h"

#include <algorithm>
#include <numbers>
#include <numeric>

namespace
{
constexpr double kPi = std::numbers::pi;
// Lights below this fraction of the total would have a probability that single precision cannot divide by.
constexpr double kLeastShare = 1e-30;

struct Candidate
{
    gpu::Light light;
    double power;                   // W, luminance
    bool keep = false;              // where it has no power, too
    uint32_t punctual = gpu::kNone; // its number in the scene
};

/// Radius of the sphere about the scene's box.
double sceneRadius(const WorldMesh& mesh)
{
    if (mesh.positions.empty())
        return 0;
    gpu::vec3 low = mesh.positions[0];
    gpu::vec3 high = low;
    for (const gpu::vec3& p : mesh.positions)
    {
        low = min(low, p);
        high = max(high, p);
    }
    return length(toDouble(high) - toDouble(low)) / 2;
}

/// Solid angle of a spot's cone weighted by its falloff, which rises as a square from the rim to `width` inside it.
double spotSolidAngle(double cos_outer, double width)
{
    const double rim = std::min(width, 1 - cos_outer);
    const double full = std::max(0.0, 1 - cos_outer - width);
    return 2 * kPi * (full + rim * rim * rim / (3 * width * width));
}

Candidate punctual(const PunctualLight& source, double scene_radius)
{
    Candidate c{.light = {.p0 = toFloat(source.position),
                          .kind = source.kind,
                          .p1 = source.direction,
                          .triangle = gpu::kNone,
                          .p2 = {},
                          .pmf = 0,
                          .emission = source.intensity,
                          .material = gpu::kNone},
                .power = luminance(source.intensity)};
    if (source.kind == gpu::kLightPoint)
        c.power *= 4 * kPi;
    else if (source.kind == gpu::kLightDirectional)
        c.power *= kPi * scene_radius * scene_radius;
    else
    {
        c.light.p2 = package::spotCone(source.inner_cone, source.outer_cone);
        c.power *= spotSolidAngle(std::cos(source.outer_cone), 1 / double(c.light.p2.x));
    }
    return c;
}

Candidate emissiveTriangle(const SceneData& scene, uint32_t triangle)
{
    const uint32_t material_index = scene.mesh.materials[triangle];
    const gpu::Material& material = scene.materials[material_index];
    const gpu::uvec3& v = scene.mesh.triangles[triangle];
    const gpu::vec3 p0 = scene.mesh.positions[v.x];
    const gpu::vec3 p1 = scene.mesh.positions[v.y];
    const gpu::vec3 p2 = scene.mesh.positions[v.z];
    const bool textured = material.emissive_texture != gpu::kNone;
    const bool two_sided = (material.flags & gpu::kMaterialDoubleSided) != 0;

    gpu::vec3 mean = material.emission;
    if (textured)
    {
        const gpu::vec3 texture = averageEmissiveTexture(scene, triangle);
        mean = {mean.x * texture.x, mean.y * texture.y, mean.z * texture.z};
    }
    const bool masked = (material.flags & gpu::kMaterialAlphaMask) != 0;
    const bool blended = (material.flags & gpu::kMaterialAlphaBlend) != 0;
    if (blended)
        mean = mean * material.alpha; // textures may take more away
    if (masked && material.alpha < material.alpha_cutoff)
        mean = {}; // nothing is there
    const Vec3d origin = toDouble(p0);
    const double area = length(cross(toDouble(p1) - origin, toDouble(p2) - origin)) / 2;
    return {.light = {.p0 = p0,
                      .kind = two_sided ? gpu::kLightTriangleTwoSided : gpu::kLightTriangle,
                      .p1 = p1,
                      .triangle = triangle,
                      .p2 = p2,
                      .pmf = 0,
                      .emission = material.emission,
                      .material = textured || masked || blended ? material_index : gpu::kNone},
            .power = kPi * area * luminance(mean) * (two_sided ? 2 : 1)};
}

bool emits(const gpu::Material& material)
{
    return (material.flags & gpu::kMaterialUnlit) == 0 && luminance(material.emission) > 0;
}

std::vector<Candidate> collect(const SceneData& scene)
{
    const double radius = sceneRadius(scene.mesh);
    std::vector<Candidate> candidates;
    for (const PunctualLight& light : scene.lights)
    {
        candidates.push_back(punctual(light, radius));
        candidates.back().keep = light.moves;
        candidates.back().punctual = uint32_t(candidates.size() - 1);
    }
    for (uint32_t i = 0; i < scene.mesh.triangles.size(); ++i)
    {
        if (emits(scene.materials[scene.mesh.materials[i]]))
        {
            candidates.push_back(emissiveTriangle(scene, i));
            candidates.back().keep = i >= scene.mesh.staticTriangleCount();
        }
    }
    if (scene.environment)
    {
        const double over_sphere = 4 * kPi * luminance(averageRadiance(*scene.environment));
        candidates.push_back({.light = {.p0 = {},
                                        .kind = gpu::kLightEnvironment,
                                        .p1 = {},
                                        .triangle = gpu::kNone,
                                        .p2 = {},
                                        .pmf = 0,
                                        .emission = {1, 1, 1},
                                        .material = gpu::kNone},
                              .power = kPi * radius * radius * over_sphere});
    }
    return candidates;
}

double totalPower(const std::vector<Candidate>& candidates)
{
    return std::accumulate(candidates.begin(), candidates.end(), 0.0,
                           [](double sum, const Candidate& c) { return sum + c.power; });
}
bool isBeam(const Candidate& c)
{
    return c.light.kind == gpu::kLightDirectional || c.light.kind == gpu::kLightEnvironment;
}

/// The weight by which each light is picked: its power, except that directional and environment lights beside local ones get
/// at most half of all samples. Their power is what falls on a disc as wide as the scene: indoors nearly all of that hits the
/// roof, and the local lights that light the room would get next to no samples. What is dark at rest and may shine later is
/// picked like an average light.
std::vector<double> sampleShares(const std::vector<Candidate>& candidates)
{
    constexpr double kMostBeams = 0.5;
    const double total = totalPower(candidates);
    if (total == 0) // all of them move, and are dark at rest
        return std::vector<double>(candidates.size(), 1 / double(candidates.size()));
    double beams = 0, lamps = 0;
    for (const Candidate& c : candidates)
        (isBeam(c) ? beams : lamps) += c.power / total;
    const bool capped = beams > kMostBeams && lamps > 0;
    const double average = 1 / double(candidates.size());
    const double dark = average * double(std::ranges::count(candidates, 0.0, &Candidate::power));
    std::vector<double> shares;
    for (const Candidate& c : candidates)
    {
        const double group = isBeam(c) ? kMostBeams / beams : (1 - kMostBeams) / lamps;
        shares.push_back(c.power > 0 ? c.power / total * (capped ? group : 1) * (1 - dark) : average);
    }
    return shares;
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
    const double least = totalPower(candidates) * kLeastShare;
    std::erase_if(candidates, [&](const Candidate& c) { return !(c.power > least) && !c.keep; });
    for (Candidate& c : candidates)
        if (!(c.power > least))
            c.power = 0;
    tables.total_power = float(totalPower(candidates));
    for (uint32_t i = 0; i < candidates.size(); ++i)
        if (candidates[i].punctual != gpu::kNone)
            tables.of_punctual[candidates[i].punctual] = i;
    if (candidates.empty())
        return tables;

    const std::vector<double> shares = sampleShares(candidates);
    for (size_t i = 0; i < candidates.size(); ++i)
    {
        Candidate& c = candidates[i];
        c.light.pmf = float(shares[i]);
        tables.emissive_triangles += c.light.triangle != gpu::kNone ? 1 : 0;
        tables.lights.push_back(c.light);
        tables.powers.push_back(float(c.power));
    }
    tables.aliases = buildAliasTable(shares);
    return tables;
}
