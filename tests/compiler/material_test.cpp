#include "compiler/gltf_material.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
/// Imports one triangle with `material`; the file has a 1 x 1 texture 0 of the given alpha.
Result<SceneData> withMaterial(const nlohmann::json& material, uint8_t alpha = 255)
{
    GltfBuilder builder;
    builder.texture(1, 1, {10, 20, 30, alpha});
    builder.material(material);
    builder.triangle({{"material", 0}});
    return builder.scene();
}

TEST(Material, DefaultsAreGltfs)
{
    const Result<SceneData> scene = withMaterial(nlohmann::json::object());
    ASSERT_TRUE(scene) << scene.error().message;
    const gpu::Material& m = scene->materials[0];
    EXPECT_EQ(m.base_color.x, 1);
    EXPECT_EQ(m.alpha, 1);
    EXPECT_EQ(m.metallic, 1);
    EXPECT_EQ(m.roughness, 1);
    EXPECT_EQ(m.ior, 1.5f);
    EXPECT_EQ(m.specular, 1);
    EXPECT_EQ(m.specular_color.y, 1);
    EXPECT_EQ(m.transmission, 0);
    EXPECT_EQ(m.emission.x, 0);
    EXPECT_EQ(m.flags, 0u);
    EXPECT_EQ(m.base_color_texture, gpu::kNone);
    EXPECT_EQ(m.specular_color_texture, gpu::kNone);
    EXPECT_TRUE(scene->images.empty()); // the texture is in the file, but nothing uses it
}

TEST(Material, EmissionIsFactorTimesStrength)
{
    const Result<SceneData> scene =
        withMaterial({{"emissiveFactor", {1, 0.5, 0}},
                      {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}});
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->materials[0].emission.x, 8);
    EXPECT_EQ(scene->materials[0].emission.y, 4);
    EXPECT_EQ(scene->materials[0].emission.z, 0);
}

TEST(Material, TransmissionIsThinWithoutThicknessAndAbsorbsWithIt)
{
    const nlohmann::json transmission = {{"transmissionFactor", 1}};
    const auto thin = withMaterial(
        {{"extensions",
          {{"KHR_materials_transmission", transmission}, {"KHR_materials_volume", {{"thicknessFactor", 0}}}}}});
    ASSERT_TRUE(thin) << thin.error().message;
    EXPECT_EQ(thin->materials[0].flags, gpu::kMaterialThin);
    const auto solid = withMaterial(
        {{"extensions",
          {{"KHR_materials_transmission", transmission},
           {"KHR_materials_ior", {{"ior", 1.33}}},
           {"KHR_materials_volume",
            {{"thicknessFactor", 0.1}, {"attenuationDistance", 2}, {"attenuationColor", {0.5, 1, 0.25}}}}}}});
    ASSERT_TRUE(solid) << solid.error().message;
    const gpu::Material& m = solid->materials[0];
    EXPECT_EQ(m.flags, 0u);
    EXPECT_FLOAT_EQ(m.ior, 1.33f);
    EXPECT_NEAR(std::exp(-2 * m.absorption.x), 0.5, 1e-6); // after attenuationDistance metres
    EXPECT_NEAR(std::exp(-2 * m.absorption.y), 1, 1e-6);
    EXPECT_NEAR(std::exp(-2 * m.absorption.z), 0.25, 1e-6);
}

TEST(Material, TrianglesAreFlaggedAlphaOnlyWhereCoverageCanBeBelowOne)
{
    const auto flags = [](const nlohmann::json& material, uint8_t texture_alpha)
    {
        const Result<SceneData> scene = withMaterial(material, texture_alpha);
        return scene ? materialTriangleFlags(*scene)[0] : 99u;
    };
    const nlohmann::json textured = {{"alphaMode", "MASK"},
                                     {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}};
    const nlohmann::json opaque = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}};
    EXPECT_EQ(flags(textured, 255), 0u);
    EXPECT_EQ(flags(textured, 254), gpu::kTriangleAlpha);
    EXPECT_EQ(flags(opaque, 0), 0u);
    EXPECT_EQ(flags({{"alphaMode", "BLEND"}}, 255), 0u);
    EXPECT_EQ(flags({{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}}}, 255),
              gpu::kTriangleAlpha);
}

TEST(Material, OnlySmoothThinTransmissionLetsShadowRaysPass)
{
    const auto flags = [](double roughness)
    {
        const Result<SceneData> scene =
            withMaterial({{"pbrMetallicRoughness", {{"roughnessFactor", roughness}}},
                          {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
        return scene ? materialTriangleFlags(*scene)[0] : 99u;
    };
    EXPECT_EQ(flags(0), gpu::kTriangleThin);
    EXPECT_EQ(flags(0.2), 0u);
}

TEST(Material, TextureTransformScalesTurnsThenMoves)
{
    GltfBuilder builder;
    const int texture = builder.texture(1, 1, {1, 2, 3, 255});
    builder.json["textures"][0]["sampler"] = 0;
    builder.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    builder.material({{"pbrMetallicRoughness",
                       {{"baseColorTexture",
                         {{"index", texture},
                          {"extensions",
                           {{"KHR_texture_transform",
                             {{"offset", {0.5, 0.25}},
                              {"rotation", std::acos(-1.0) / 2},
                              {"scale", {2, 3}},
                              {"texCoord", 1}}}}}}}}}});
    builder.triangle({{"material", 0}});
    const auto imported = builder.import();
    ASSERT_TRUE(imported) << imported.error().message;
    ASSERT_EQ(imported->scene.texture_uses.size(), 1u);
    const TextureUse& use = imported->scene.texture_uses[0];
    // A quarter turn counter-clockwise as seen, with v down: (u, v) -> (v, -u).
    const float want_u[3] = {0, 3, 0.5f};
    const float want_v[3] = {-2, 0, 0.25f};
    for (int i = 0; i < 3; ++i)
    {
        EXPECT_NEAR((&use.u_row.x)[i], want_u[i], 1e-6);
        EXPECT_NEAR((&use.v_row.x)[i], want_v[i], 1e-6);
    }
    EXPECT_EQ(use.sampling, gpu::kWrapClamp | gpu::kWrapMirror << 2 | gpu::kSampleNearest | gpu::kSampleUv1);
}

TEST(Material, AnImageUsedAsColourAndAsDataIsStoredOnceEach)
{
    GltfBuilder builder;
    const int texture = builder.texture(1, 1, {1, 2, 3, 255});
    const nlohmann::json info = {{"index", texture}};
    builder.material({{"pbrMetallicRoughness", {{"baseColorTexture", info}, {"metallicRoughnessTexture", info}}},
                      {"emissiveTexture", info},
                      {"emissiveFactor", {1, 1, 1}}});
    builder.triangle({{"material", 0}});
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->images.size(), 2u);
    EXPECT_TRUE(scene->images[0].srgb);
    EXPECT_FALSE(scene->images[1].srgb);
    EXPECT_EQ(scene->images[0].texels, scene->images[1].texels);
    const gpu::Material& m = scene->materials[0];
    EXPECT_EQ(scene->texture_uses[m.emissive_texture].image, scene->texture_uses[m.base_color_texture].image);
}

TEST(Material, SpecularGlossinessBecomesADielectricWithTheSameF0)
{
    const Result<SceneData> scene = withMaterial({{"extensions",
                                                   {{"KHR_materials_pbrSpecularGlossiness",
                                                     {{"diffuseFactor", {0.1, 0.2, 0.3, 1}},
                                                      {"specularFactor", {0.5, 0.6, 0.7}},
                                                      {"glossinessFactor", 0.75}}}}}});
    ASSERT_TRUE(scene) << scene.error().message;
    const gpu::Material& m = scene->materials[0];
    EXPECT_FLOAT_EQ(m.base_color.y, 0.2f);
    EXPECT_EQ(m.metallic, 0);
    EXPECT_FLOAT_EQ(m.roughness, 0.25f);
    const float f0 = (m.ior - 1) / (m.ior + 1) * (m.ior - 1) / (m.ior + 1);
    EXPECT_NEAR(f0 * m.specular_color.x, 0.5, 1e-6);
}
} // namespace
