// Layers of materials whose direction a file says: a coat's own normal map, an anisotropic surface's grain. Pictures of
// points under one light, where the formulas hold for a single pair of directions.
#include "tests/stages/closed_form.h"
#include "tests/stages/double3.h"

#include <fmt/format.h>

#include <cmath>

namespace
{
constexpr double kIrradiance = 10; // on what faces the light

double square(double x)
{
    return x * x;
}

/// GGX reflection of a smooth boundary's Fresnel reflectance, times the cosine to the light (Walter et al. 2007;
/// separable Smith).
/// @param along, across GGX widths; directions local to the microfacets' normal
double reflected(double along, double across, double normal_reflectance, Double3 wo, Double3 wi)
{
    const Double3 h = normalized(wo + wi);
    const double slope = square(h.x / along) + square(h.y / across) + square(h.z);
    const double distribution = 1 / (kPi * along * across * square(slope));
    const auto masking = [&](Double3 v)
    { return 2 / (1 + std::sqrt(1 + (square(along * v.x) + square(across * v.y)) / square(v.z))); };
    const double fresnel = normal_reflectance + (1 - normal_reflectance) * std::pow(1 - dot(wo, h), 5);
    return fresnel * distribution * masking(wo) * masking(wi) / (4 * wo.z);
}

struct Frame // x, y, z: unit, at right angles
{
    Double3 x, y, z;
    Double3 local(Double3 w) const { return {dot(w, x), dot(w, y), dot(w, z)}; }
};

/// The upright, leant towards `side`.
Double3 from(double degrees, Double3 side)
{
    return std::cos(degrees * kDegree) * Double3(0, 1, 0) + std::sin(degrees * kDegree) * side;
}

/// Horizontal squares at the origin and then 10 m apart along X, one a material, under a directional light. Their
/// TEXCOORD_0 rises along +X and -Z: tangents are +X, bitangents, against v, +Z.
class Layers : public ClosedForm
{
protected:
    std::unique_ptr<SceneGpu> squares(SceneBuilder& builder, const std::vector<nlohmann::json>& materials, Double3 wi)
    {
        for (size_t i = 0; i < materials.size(); ++i)
            builder.quad({10 * float(i) - 2, 0, 2}, {4, 0, 0}, {0, 0, -4}, builder.material(materials[i]));
        // Lights shine along -Z: turned about the axis across both.
        const Double3 z(0, 0, 1), axis = normalized(cross(z, wi));
        const double half = std::acos(dot(z, wi)) / 2;
        builder.light({{"type", "directional"}, {"intensity", kIrradiance}},
                      {{"rotation",
                        {std::sin(half) * axis.x, std::sin(half) * axis.y, std::sin(half) * axis.z, std::cos(half)}}});
        return load(builder.compile());
    }
    void expectRadiance(const std::string& what, const SceneGpu& scene, size_t square, Double3 wo, double reflected)
    {
        const Camera camera = viewOf({10 * float(square), 0, 0}, {float(wo.x), float(wo.y), float(wo.z)});
        expect(what, scene, camera, Mode::kDirect, grey(kIrradiance * reflected), {});
    }
};

/// A black surface under a coat: seen from where the coat's normal mirrors the light it shines, from where the
/// surface's would it is dark, both by the same formula about the coat's normal. No other material has a map of
/// normals.
TEST_F(Layers, CoatShinesAboutItsOwnNormalMap)
{
    const std::array<uint8_t, 3> texel{168, 150, 245}; // to the right and up
    Double3 mapped(texel[0] * 2 / 255.0 - 1, texel[1] * 2 / 255.0 - 1, 0);
    mapped.z = std::sqrt(1 - square(mapped.x) - square(mapped.y)); // normal maps keep two channels
    const Double3 normal(mapped.x, mapped.z, mapped.y), side = normalized(cross(normal, {0, 0, 1}));
    const Frame coat{side, cross(normal, side), normal};
    const double roughness = 0.4, alpha = square(roughness);
    SceneBuilder builder;
    const int map = builder.texture(1, 1, {texel[0], texel[1], texel[2], 255});
    const Double3 wi = from(20, {0.6, 0, 0.8});
    const auto scene = squares(builder,
                               {with(lambert(0), {{"extensions",
                                                   {{"KHR_materials_clearcoat",
                                                     {{"clearcoatFactor", 1},
                                                      {"clearcoatRoughnessFactor", roughness},
                                                      {"clearcoatNormalTexture", {{"index", map}}}}}}}})},
                               wi);
    const Double3 by_coat = 2 * dot(wi, normal) * normal - wi, by_surface(-wi.x, wi.y, -wi.z);
    const auto value = [&](Double3 wo) { return reflected(alpha, alpha, 0.04, coat.local(wo), coat.local(wi)); };
    EXPECT_GT(value(by_coat), 4 * value(by_surface));
    expectRadiance("mirrored by the coat", *scene, 0, by_coat, value(by_coat));
    expectRadiance("mirrored by the surface", *scene, 0, by_surface, value(by_surface));
}

/// Brushed metal: its lobe is wide along the direction that the tangent, turned by the rotation, gives, and the map's
/// direction adds to it (KHR_materials_anisotropy).
TEST_F(Layers, GrainLiesAlongTheTangentTurnedByRotationAndMap)
{
    struct Grain
    {
        double rotation; // degrees, from the tangent to the bitangent
        std::array<uint8_t, 3> texel;
    };
    const std::array<Grain, 4> grains{
        {{0, {255, 127, 255}}, {90, {255, 127, 255}}, {30, {255, 127, 255}}, {30, {126, 254, 128}}}};
    const double strength = 0.8, roughness = 0.5, alpha = square(roughness);
    const Double3 wo = from(25, {0.8, 0, 0.6}), wi = from(35, normalized({0.9, 0, -0.2})), up(0, 1, 0);
    SceneBuilder builder;
    std::vector<nlohmann::json> materials;
    for (const Grain& g : grains)
        materials.push_back({{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", roughness}}},
                             {"extensions",
                              {{"KHR_materials_anisotropy",
                                {{"anisotropyStrength", strength},
                                 {"anisotropyRotation", g.rotation * kDegree},
                                 {"anisotropyTexture",
                                  {{"index", builder.texture(1, 1, {g.texel[0], g.texel[1], g.texel[2], 255})}}}}}}}});
    const auto scene = squares(builder, materials, wi);
    for (size_t i = 0; i < grains.size(); ++i)
    {
        const Grain& g = grains[i];
        const double turn = g.rotation * kDegree + std::atan2(g.texel[1] * 2 / 255.0 - 1, g.texel[0] * 2 / 255.0 - 1);
        const Double3 along(std::cos(turn), 0, std::sin(turn));
        const Frame frame{along, cross(up, along), up};
        const double wide = alpha + (1 - alpha) * square(strength * g.texel[2] / 255);
        expectRadiance(fmt::format("rotation {}, map {} {}", g.rotation, g.texel[0], g.texel[1]), *scene, i, wo,
                       reflected(wide, alpha, 1, frame.local(wo), frame.local(wi)));
    }
}
} // namespace
