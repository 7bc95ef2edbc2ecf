// Reflection as glTF defines it: single directions exactly, and a whole white sky against integration on the CPU.
#include "tests/stages/closed_form.h"
#include "tests/stages/gltf_brdf.h"

#include <cmath>

namespace
{
nlohmann::json asGltf(const GltfMaterial& m)
{
    return {
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {m.base_color[0], m.base_color[1], m.base_color[2], 1}},
          {"metallicFactor", m.metallic},
          {"roughnessFactor", m.roughness}}},
        {"extensions",
         {{"KHR_materials_ior", {{"ior", m.ior}}},
          {"KHR_materials_specular", {{"specularFactor", m.specular}, {"specularColorFactor", m.specular_color}}}}}};
}

constexpr GltfMaterial kDielectric{.base_color = {0.5, 0.5, 0.5}};
constexpr GltfMaterial kMetal{.base_color = {0.9, 0.6, 0.3}, .metallic = 1};
constexpr GltfMaterial kMixed{.base_color = {0.9, 0.6, 0.3}, .metallic = 0.4};
constexpr GltfMaterial kCoated{
    .base_color = {0.2, 0.5, 0.8}, .ior = 1.8, .specular = 0.7, .specular_color = {1, 0.5, 0.2}};

struct Named
{
    const char* name;
    GltfMaterial material;
};

GltfMaterial rough(GltfMaterial material, double roughness)
{
    material.roughness = roughness;
    return material;
}

class Brdf : public ClosedForm
{
protected:
    void expectWhiteSky(const Named& named, double roughness)
    {
        SceneBuilder builder;
        const GltfMaterial material = rough(named.material, roughness);
        builder.floor(4, 0, builder.material(asGltf(material)));
        builder.environment({.width = 1, .height = 1, .rgb = {1, 1, 1}});
        const auto scene = load(builder.compile());
        for (const double degrees : {0.0, 60.0, 80.0})
        {
            const double angle = degrees * kDegree;
            const std::string what = fmt::format("{}, roughness {}, {} degrees", named.name, roughness, degrees);
            const Camera camera = viewOf({0, 0, 0}, {float(std::sin(angle)), float(std::cos(angle)), 0});
            const Rgb want = directionalAlbedo(material, std::cos(angle));
            const Sampling few{.side = 32, .sample_count = 96, .depth = 3}, many{.side = 64, .sample_count = 256};
            expect(what, *scene, camera, Mode::kReference, want, few);
            // Direct mode chooses between a mirror and what lies below it by chance.
            expect(what, *scene, camera, Mode::kDirect, want, roughness == 0 && material.metallic < 1 ? many : few);
        }
    }

    /// A point light and a viewer at chosen angles: the BRDF's value, without any sampling.
    void expectLobe(const Named& named, double roughness)
    {
        SceneBuilder builder;
        const GltfMaterial material = rough(named.material, roughness);
        builder.floor(20, 0, builder.material(asGltf(material)));
        builder.light({{"type", "point"}, {"intensity", 100}}, {{"translation", {2, 2, 0}}});
        const auto scene = load(builder.compile());
        const double half = std::sqrt(0.5);
        for (const gpu::vec3 towards :
             {gpu::vec3{0, 1, 0}, {-1, 1, 0}, {-1, 0.9f, 0.1f}, {1, 1, 0}, {-5, 1, 0}, {0.5f, 0.3f, 1}})
        {
            const gpu::vec3 v = normalize(towards);
            const Rgb brdf = gltfBrdf(material, {v.x, v.z, v.y}, {half, 0, half}); // local z is the floor's y
            Rgb want{};
            for (size_t c = 0; c < 3; ++c)
                want[c] = brdf[c] * 100 / 8 * half;
            const std::string what = fmt::format("{}, roughness {}, seen from ({}, {}, {})", named.name, roughness,
                                                 towards.x, towards.y, towards.z);
            expect(what, *scene, viewOf({0, 0, 0}, towards), Mode::kReference, want,
                   {.side = 8, .sample_count = 1, .depth = 3});
            const uint32_t side = roughness == 0 ? 64 : 8;
            expect(what, *scene, viewOf({0, 0, 0}, towards), Mode::kDirect, want,
                   {.side = side, .sample_count = side * 2});
        }
    }
};

constexpr double kRoughnesses[] = {0.2, 0.5, 1};

TEST_F(Brdf, DielectricReflectsOfAWhiteSkyWhatGltfSays)
{
    expectWhiteSky({"dielectric", kDielectric}, 0);
    for (const double roughness : kRoughnesses)
        expectWhiteSky({"dielectric", kDielectric}, roughness);
}

TEST_F(Brdf, MetalReflectsOfAWhiteSkyWhatGltfSays)
{
    expectWhiteSky({"metal", kMetal}, 0);
    for (const double roughness : kRoughnesses)
        expectWhiteSky({"metal", kMetal}, roughness);
}

TEST_F(Brdf, MixedAndCoatedMaterialsReflectOfAWhiteSkyWhatGltfSays)
{
    expectWhiteSky({"40 % metal", kMixed}, 0.5);
    expectWhiteSky({"coloured coat", kCoated}, 0.5);
    expectWhiteSky({"coloured coat", kCoated}, 0);
}

TEST_F(Brdf, LobesUnderAPointLightAreGltfs)
{
    for (const Named& named :
         {Named{"dielectric", kDielectric}, {"metal", kMetal}, {"40 % metal", kMixed}, {"coloured coat", kCoated}})
        for (const double roughness : kRoughnesses)
            expectLobe(named, roughness);
}

/// A perfect mirror shows a point light nowhere; only what lies below it is lit.
TEST_F(Brdf, SmoothDielectricIsLitBelowItsMirror)
{
    expectLobe({"dielectric", kDielectric}, 0);
}

TEST_F(Brdf, UnlitShowsItsBaseColourAndNeedsNoLight)
{
    SceneBuilder builder;
    builder.floor(4, 0,
                  builder.material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.4, 0.2, 1}}}},
                                    {"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}}}));
    const auto scene = load(builder.compile());
    EXPECT_EQ(scene->info().light_count, 0u);
    expectBoth("unlit", *scene, viewOf({0, 0, 0}, {0.3f, 1, 0.2f}), {0.8, 0.4, 0.2}, {});
}
} // namespace
