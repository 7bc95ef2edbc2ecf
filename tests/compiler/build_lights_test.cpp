// Light powers against closed forms, the alias table against the probabilities it must draw with.
#include "compiler/build_lights.h"
#include "compiler/environment.h"
#include "compiler/vector_math.h"
#include "format/material.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace
{
constexpr double kPi = std::numbers::pi;

gpu::Material material()
{
    gpu::Material m = package::defaultMaterial();
    m.metallic = 0;
    return m;
}

/// A right triangle of area 0.5 at `x` with texture coordinates that equal its local ones.
void addTriangle(SceneData& scene, float x, uint32_t material_index, uint32_t object = 0)
{
    WorldMesh& mesh = scene.mesh;
    const uint32_t first = uint32_t(mesh.positions.size());
    for (const gpu::vec2 uv : {gpu::vec2{0, 0}, gpu::vec2{1, 0}, gpu::vec2{0, 1}})
    {
        mesh.positions.push_back({x + uv.x, uv.y, 0});
        mesh.attributes.push_back({0, 0, uv, uv, {0, 0}});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.materials.push_back(material_index);
    mesh.objects.push_back(object);
    mesh.object_count = std::max(mesh.object_count, object + 1);
}

/// One dark triangle, so that the scene has a size: box 1 x 1 x 0, bounding sphere of radius sqrt(2) / 2.
SceneData darkScene()
{
    SceneData scene;
    scene.materials.push_back(material());
    addTriangle(scene, 0, 0);
    return scene;
}

double powerOf(const SceneData& scene)
{
    return buildLights(scene).total_power;
}

SceneData withPunctual(const PunctualLight& light)
{
    SceneData scene = darkScene();
    scene.lights.push_back(light);
    return scene;
}

/// Falloff of KHR_lights_punctual integrated over the cone in small rings; good to 1e-6.
double spotPower(double inner, double outer)
{
    const double scale = 1 / std::max(0.001, std::cos(inner) - std::cos(outer));
    double sum = 0;
    constexpr int kRings = 200000;
    const double width = (1 - std::cos(outer)) / kRings;
    for (int i = 0; i < kRings; ++i)
    {
        const double falloff = std::clamp((i + 0.5) * width * scale, 0.0, 1.0);
        sum += falloff * falloff;
    }
    return sum * width * 2 * kPi;
}

SceneData withEmitter(const gpu::Material& m)
{
    SceneData scene = darkScene();
    scene.materials.push_back(m);
    addTriangle(scene, 2, 1);
    return scene;
}
} // namespace

TEST(BuildLights, PointLightPower)
{
    EXPECT_NEAR(powerOf(withPunctual({.kind = gpu::kLightPoint, .intensity = {3, 3, 3}})), 4 * kPi * 3, 1e-4);
}

TEST(BuildLights, DirectionalLightPowerIsOverTheBoundingDisc)
{
    EXPECT_NEAR(powerOf(withPunctual({.kind = gpu::kLightDirectional, .intensity = {2, 2, 2}})), kPi * 0.5 * 2, 1e-5);
}

TEST(BuildLights, SpotLightPowerIsTheIntegralOfItsFalloff)
{
    const std::pair<float, float> cones[] = {{0.0f, 0.8f}, {0.3f, 0.5f}, {0.5f, 0.5f}, {0.0f, 0.02f}, {1.0f, 1.57f}};
    for (const auto& [inner, outer] : cones)
    {
        const double power = powerOf(
            withPunctual({.kind = gpu::kLightSpot, .intensity = {1, 1, 1}, .inner_cone = inner, .outer_cone = outer}));
        EXPECT_NEAR(power, spotPower(inner, outer), 1e-3 * power) << inner << " " << outer;
    }
}

TEST(BuildLights, EmissiveTriangles)
{
    gpu::Material lamp = material();
    lamp.emission = {5, 5, 5};
    EXPECT_NEAR(powerOf(withEmitter(lamp)), kPi * 0.5 * 5, 1e-4);

    lamp.flags = gpu::kMaterialDoubleSided;
    const LightTables tables = buildLights(withEmitter(lamp));
    EXPECT_NEAR(tables.total_power, 2 * kPi * 0.5 * 5, 1e-4);
    ASSERT_EQ(tables.lights.size(), 1u);
    EXPECT_EQ(tables.lights[0].kind, gpu::kLightTriangleTwoSided);
    EXPECT_EQ(tables.lights[0].triangle, 1u);
    EXPECT_EQ(tables.lights[0].material, gpu::kNone);
    EXPECT_EQ(tables.emissive_triangles, 1u);
}

TEST(BuildLights, UnlitMaterialsAreNoLights)
{
    gpu::Material sign = material();
    sign.emission = {5, 5, 5};
    sign.flags = gpu::kMaterialUnlit;
    EXPECT_TRUE(buildLights(withEmitter(sign)).lights.empty());
}

TEST(BuildLights, EmissiveTexturesAreAveragedOverTheTriangle)
{
    gpu::Material lamp = material();
    lamp.emission = {8, 8, 8};
    lamp.emissive_texture = 0;
    SceneData scene = withEmitter(lamp);
    scene.texture_uses.push_back({.image = 0});
    TextureImage image{.name = "half", .width = 64, .height = 64, .srgb = true, .texels = {}};
    for (int i = 0; i < 64 * 64; ++i)
        image.texels.insert(image.texels.end(), 4, uint8_t(i % 64 < 32 ? 188 : 0)); // sRGB 188 is linear 0.5029
    scene.images.push_back(image);

    // Three quarters of the triangle's area lie at u < 0.5.
    const LightTables tables = buildLights(scene);
    EXPECT_NEAR(tables.total_power, kPi * 0.5 * 8 * 0.75 * 0.5029, 1e-4 * tables.total_power);
    ASSERT_EQ(tables.lights.size(), 1u);
    EXPECT_EQ(tables.lights[0].material, 1u);

    scene.texture_uses[0].u_row = {0, 0, 0.9f}; // KHR_texture_transform to the dark half
    EXPECT_TRUE(buildLights(scene).lights.empty());
}

TEST(BuildLights, AlphaTakesItsShareOfTheEmission)
{
    gpu::Material lamp = material();
    lamp.emission = {8, 8, 8};
    lamp.alpha = 0.25f;
    const double opaque = powerOf(withEmitter(lamp));
    lamp.flags = gpu::kMaterialAlphaBlend;
    const LightTables tables = buildLights(withEmitter(lamp));
    EXPECT_NEAR(tables.total_power, 0.25 * opaque, 1e-6 * opaque);
    ASSERT_EQ(tables.lights.size(), 1u);
    EXPECT_EQ(tables.lights[0].material, 1u); // shaders look up the coverage there
    EXPECT_EQ(tables.lights[0].emission.x, 8);

    lamp.flags = gpu::kMaterialAlphaMask;
    lamp.alpha_cutoff = 0.2f;
    EXPECT_NEAR(powerOf(withEmitter(lamp)), opaque, 1e-6 * opaque);
    lamp.alpha_cutoff = 0.5f;
    EXPECT_TRUE(buildLights(withEmitter(lamp)).lights.empty());
}

TEST(BuildLights, EnvironmentIsTheLastLight)
{
    SceneData scene = withPunctual({.kind = gpu::kLightPoint, .intensity = {1, 1, 1}});
    scene.environment = EnvironmentImage{.width = 8, .height = 4, .texels = std::vector<gpu::vec4>(32, {2, 2, 2, 1})};
    const LightTables tables = buildLights(scene);
    ASSERT_EQ(tables.lights.size(), 2u);
    EXPECT_EQ(tables.lights[1].kind, gpu::kLightEnvironment);
    EXPECT_NEAR(tables.total_power, 4 * kPi + kPi * 0.5 * 4 * kPi * 2, 1e-3);
}

TEST(BuildLights, AliasTableDrawsEachLightWithItsShareOfThePower)
{
    SceneData scene = darkScene();
    for (int i = 1; i <= 37; ++i)
        scene.lights.push_back({.kind = gpu::kLightPoint, .intensity = {float(i * i), 0, float(i % 5)}});
    scene.lights.push_back({.kind = gpu::kLightPoint, .intensity = {}}); // without power: left out
    const LightTables tables = buildLights(scene);
    ASSERT_EQ(tables.lights.size(), 37u);
    ASSERT_EQ(tables.aliases.size(), 37u);
    std::vector<double> drawn(37);
    for (size_t i = 0; i < 37; ++i)
    {
        drawn[i] += tables.aliases[i].threshold / 37.0;
        drawn[tables.aliases[i].alias] += (1.0 - tables.aliases[i].threshold) / 37.0;
    }
    for (size_t i = 0; i < 37; ++i)
    {
        const double share = 4 * kPi * luminance(scene.lights[i].intensity) / tables.total_power;
        EXPECT_NEAR(drawn[i], share, 1e-6);
        EXPECT_NEAR(tables.lights[i].pmf, share, 1e-6);
    }
}

TEST(BuildLights, ASunLeavesHalfOfTheSamplesToLamps)
{
    SceneData scene = withPunctual({.kind = gpu::kLightDirectional, .intensity = {1000, 1000, 1000}});
    EXPECT_EQ(buildLights(scene).lights.at(0).pmf, 1); // alone it has all
    SceneData suns = scene;
    for (const float i : {3.0f, 0.7f, 0.1f})
        suns.lights.push_back({.kind = gpu::kLightDirectional, .intensity = {i, i, i}});
    EXPECT_GT(buildLights(suns).lights.at(0).pmf, 0.99); // and so have suns among themselves
    scene.lights.push_back({.kind = gpu::kLightPoint, .intensity = {1, 1, 1}});
    scene.lights.push_back({.kind = gpu::kLightPoint, .intensity = {3, 3, 3}});
    const LightTables tables = buildLights(scene);
    ASSERT_EQ(tables.lights.size(), 3u);
    EXPECT_NEAR(tables.lights[0].pmf, 0.5, 1e-6);
    EXPECT_NEAR(tables.lights[1].pmf, 0.125, 1e-6);
    EXPECT_NEAR(tables.lights[2].pmf, 0.375, 1e-6);
    scene.lights[0].intensity = {0.001f, 0.001f, 0.001f}; // a faint one has its share of the power
    EXPECT_LT(buildLights(scene).lights.at(0).pmf, 0.01);
}

TEST(BuildLights, ALightThatMayShineLaterIsThereAndNotPicked)
{
    SceneData scene = withPunctual({.kind = gpu::kLightPoint, .intensity = {3, 3, 3}});
    scene.lights.push_back({.kind = gpu::kLightPoint, .intensity = {1, 1, 1}});
    scene.lights.push_back({.kind = gpu::kLightPoint, .intensity = {}});
    scene.lights.push_back({.kind = gpu::kLightPoint, .intensity = {}});
    scene.lights.back().moves = true;
    const LightTables tables = buildLights(scene); // the third, dark for ever, is left out
    ASSERT_EQ(tables.lights.size(), 3u);
    EXPECT_NEAR(tables.lights[0].pmf, 0.75, 1e-6);
    EXPECT_NEAR(tables.lights[1].pmf, 0.25, 1e-6);
    EXPECT_EQ(tables.lights[2].pmf, 0);
    for (uint32_t i = 0; i < 3; ++i)
        EXPECT_NE(tables.aliases[i].threshold < 1 ? tables.aliases[i].alias : i, 2u) << "drawn by entry " << i;
    EXPECT_EQ(tables.aliases[2].threshold, 0);
}

TEST(BuildLights, TrianglesOfMaterialsThatBeginToEmitAreLights)
{
    gpu::Material lamp = material();
    lamp.flags = gpu::kMaterialAlphaMask; // and what its alpha may become is not known either
    lamp.alpha = 0;
    lamp.alpha_cutoff = 0.5f;
    SceneData scene = withEmitter(lamp);
    EXPECT_TRUE(buildLights(scene).lights.empty());
    scene.motion = std::make_shared<MotionData>();
    auto& clip = scene.motion->tables.clips.emplace_back(std::make_unique<lumicut::fb::ClipT>());
    const auto channel = [&](lumicut::fb::ChannelTarget target, std::vector<float> values)
    {
        auto& c = clip->channels.emplace_back(std::make_unique<lumicut::fb::ChannelT>());
        c->target = target;
        c->index = 1;
        c->times = {0, 1};
        c->values = std::move(values);
    };
    channel(lumicut::fb::ChannelTarget::MaterialBaseColor, {1, 1, 1, 0, 1, 1, 1, 1});
    channel(lumicut::fb::ChannelTarget::MaterialEmissive, {0, 0, 0, 0, 0, 0});
    EXPECT_TRUE(buildLights(scene).lights.empty()) << "it stays dark";
    channel(lumicut::fb::ChannelTarget::MaterialEmissive, {0, 0, 0, 0, 2, 0});
    const LightTables tables = buildLights(scene);
    ASSERT_EQ(tables.lights.size(), 1u);
    EXPECT_EQ(tables.lights[0].triangle, 1u);
    EXPECT_EQ(tables.lights[0].pmf, 1) << "all are dark, and equally likely";
    EXPECT_TRUE(tables.yields.empty()) << "all of its emission counts where alpha may be anything";
}

TEST(CausticTargets, EnclosesSmoothMetalAndSolidGlassOnly)
{
    SceneData scene = darkScene();
    gpu::Material m = material();
    m.roughness = 0;
    m.transmission = 1;
    scene.materials.push_back(m); // 1: solid glass
    m.flags = gpu::kMaterialThin;
    scene.materials.push_back(m); // 2: window
    m = material();
    m.metallic = 1;
    scene.materials.push_back(m); // 3: rough metal
    m.roughness = 0.05f;
    scene.materials.push_back(m); // 4: mirror
    for (uint32_t i = 1; i <= 4; ++i)
        addTriangle(scene, 10 * float(i), i, i);
    const auto targets = buildLights(scene).caustic_targets;
    ASSERT_EQ(targets.size(), 2u);
    EXPECT_FLOAT_EQ(targets[0].center.x, 10.5f);
    EXPECT_FLOAT_EQ(targets[1].center.x, 40.5f);
    EXPECT_FLOAT_EQ(targets[0].radius, std::sqrt(0.5f));
}

TEST(CausticTargets, ManyObjectsShareAtMost64Spheres)
{
    SceneData scene = darkScene();
    gpu::Material mirror = material();
    mirror.metallic = 1;
    mirror.roughness = 0;
    scene.materials.push_back(mirror);
    for (uint32_t i = 0; i < 1000; ++i)
        addTriangle(scene, float(i * 37 % 1000), 1, i);
    const auto targets = buildLights(scene).caustic_targets;
    EXPECT_LE(targets.size(), 64u);
    EXPECT_GE(targets.size(), 32u);
    for (size_t i = 1; i < scene.mesh.triangles.size(); ++i)
    {
        const gpu::vec3& corner = scene.mesh.positions[3 * i];
        EXPECT_TRUE(std::any_of(targets.begin(), targets.end(),
                                [&](const gpu::CausticTarget& t)
                                { return length(corner - t.center) <= t.radius * 1.0001f; }));
    }
}
