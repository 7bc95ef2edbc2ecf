// Which scenes have mirrors, and in which they matter to other surfaces.
#include "compiler/delta_lobes.h"
#include "format/material.h"

#include <gtest/gtest.h>

#include <functional>

namespace
{
constexpr uint32_t kSide = 64; // texels: one is 2.4e-4 of them

/// A square metre whose texture coordinates run from 0 to 1, and a texture of white texels, for one material.
SceneData square(const std::function<void(gpu::Material&, TextureImage&)>& change)
{
    SceneData scene;
    WorldMesh& mesh = scene.mesh;
    for (const gpu::vec2 uv : {gpu::vec2{0, 0}, gpu::vec2{1, 0}, gpu::vec2{1, 1}, gpu::vec2{0, 1}})
    {
        mesh.positions.push_back({uv.x, uv.y, 0});
        mesh.attributes.push_back({0, 0, uv, uv, {0, 0}});
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.materials = {0, 0};
    mesh.objects = {0, 0};
    mesh.object_count = 1;
    scene.images.push_back(
        {.name = "", .width = kSide, .height = kSide, .texels = std::vector<uint8_t>(4 * kSide * kSide, 255)});
    scene.texture_uses.push_back({});
    gpu::Material m = package::defaultMaterial();
    m.metallic = 0;
    m.roughness = 1;
    change(m, scene.images[0]);
    scene.materials.push_back(m);
    return scene;
}

void blacken(TextureImage& image, uint32_t x, uint32_t y)
{
    image.texels[4 * (y * kSide + x) + 1] = 0;
}
} // namespace

TEST(DeltaLobes, ComeOfSmoothMaterials)
{
    EXPECT_FALSE(findDeltaLobes(square([](auto&, auto&) {})).seen);
    const DeltaLobes plastic = findDeltaLobes(square([](auto& m, auto&) { m.roughness = 0; }));
    EXPECT_TRUE(plastic.seen && plastic.matter);
    const DeltaLobes coat = findDeltaLobes(square([](auto& m, auto&) { m.clearcoat = 1; }));
    EXPECT_TRUE(coat.seen && coat.matter);
    const auto without = [](auto& m, auto&)
    {
        m.roughness = 0;
        m.specular = 0;
    };
    EXPECT_FALSE(findDeltaLobes(square(without)).seen);
    const auto unlit = [](auto& m, auto&)
    {
        m.roughness = 0;
        m.flags = gpu::kMaterialUnlit;
    };
    EXPECT_FALSE(findDeltaLobes(square(unlit)).seen);
}

TEST(DeltaLobes, OfATextureComeOfWhatTrianglesShowOfIt)
{
    const auto textured = [](gpu::Material& m, TextureImage& image)
    {
        m.metallic_roughness_texture = 0;
        blacken(image, 40, 20);
    };
    EXPECT_TRUE(findDeltaLobes(square(textured)).seen);
    SceneData scene = square(textured);
    for (gpu::VertexAttributes& v : scene.mesh.attributes)
        v.uv0 = {0.5f * v.uv0.x, 0.5f * v.uv0.y}; // which leaves that texel out
    EXPECT_FALSE(findDeltaLobes(scene).seen);
    scene.texture_uses[0].u_row = {1, 0, 0.5f};
    EXPECT_TRUE(findDeltaLobes(scene).seen);
}

TEST(DeltaLobes, MatterByTheLightThatTheySend)
{
    const auto oneTexel = [](float metallic)
    {
        return findDeltaLobes(square(
            [&](gpu::Material& m, TextureImage& image)
            {
                m.metallic_roughness_texture = 0;
                m.metallic = metallic;
                blacken(image, 40, 20);
            }));
    };
    EXPECT_TRUE(oneTexel(0).seen);
    EXPECT_FALSE(oneTexel(0).matter) << "a tenth of 2.4e-4 of the light";
    EXPECT_TRUE(oneTexel(1).matter);
}

TEST(DeltaLobes, OfWhatHasNoSizeAtRestMayGrow)
{
    SceneData scene = square(
        [](gpu::Material& m, TextureImage& image)
        {
            m.metallic_roughness_texture = 0;
            blacken(image, 0, 0);
        });
    for (gpu::vec3& p : scene.mesh.positions)
        p = {0, 0, 0};
    EXPECT_TRUE(findDeltaLobes(scene).seen);
}
