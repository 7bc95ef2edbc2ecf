// Lights that are changed on the device: tables, and pictures against those of a scene compiled with the lights as they are then.
#include "format/light_table.h"
#include "tests/stages/gi_test.h"
#include "tools/compare/welch.h"

#include <array>
#include <cmath>
#include <cstring>

namespace
{
constexpr uint32_t kWidth = 48, kHeight = 32, kSeeds = 6;

template <typename T>
bool equalBytes(std::span<const T> a, std::span<const T> b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

nlohmann::json pointLight(double intensity, std::vector<double> color = {1, 1, 1})
{
    return {{"type", "point"}, {"intensity", intensity}, {"color", std::move(color)}};
}

class ChangedLights : public GiTest
{
protected:
    /// A floor, a box, a lamp of two triangles, and lights: a point that is there before only, a point that turns red and far
    /// brighter, a spot that travels and turns, a sun that nearly sets.
    static std::filesystem::path compile(SceneBuilder& builder, bool changed)
    {
        const int white = builder.material(lambert(0.6));
        builder.floor(6, 0, white);
        builder.box({-0.5f, 0, -0.4f}, {0.3f, 0.9f, 0.3f}, white);
        builder.quad({1, 2, 0}, {0.4f, 0, 0}, {0, 0, 0.4f}, builder.material(emitter(changed ? 12 : 0.5)));
        if (!changed)
            builder.light(pointLight(9), {{"translation", {-1.5, 1.2, 1}}});
        builder.light(changed ? pointLight(6, {1, 0.25, 0.1}) : pointLight(0.01), {{"translation", {1.5, 1.5, 0.5}}});
        builder.light({{"type", "spot"}, {"intensity", 15}, {"spot", {{"outerConeAngle", changed ? 0.5 : 0.8}}}},
                      {{"translation", {changed ? -1.0 : 1.0, 2, 0.5}},
                       {"rotation", {changed ? -0.8 : -0.6, 0, 0, changed ? 0.6 : 0.8}}});
        builder.light({{"type", "directional"}, {"intensity", changed ? 0.05 : 4}},
                      {{"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}});
        return builder.compile();
    }

    static package::Package opened(const std::filesystem::path& path)
    {
        auto package = package::Package::open(path);
        check(bool(package), "{}", package ? "" : package.error().message);
        return std::move(*package);
    }

    /// What makes the lights of one package those of the other; the first is not there in the other.
    static std::vector<ChangedLight> changes(const package::Package& from, const package::Package& to)
    {
        std::vector<ChangedLight> changed{{0, from.lights()[0]}};
        changed[0].light.emission = {};
        for (uint32_t i = 1; i < from.lights().size(); ++i)
            changed.push_back({i, to.lights()[i - 1]});
        return changed;
    }

    std::vector<ImageF> pictures(const SceneGpu& scene, Mode mode)
    {
        const Camera camera{
            .name = {}, .position = {0, 1.6f, 4.5f}, .forward = {0, -0.2f, -0.98f}, .up = {0, 0.98f, -0.2f}};
        Settings settings = smallSettings();
        settings.direct_samples = 4;
        std::vector<ImageF> images;
        for (uint32_t seed = 0; seed < kSeeds; ++seed)
        {
            const Picture picture =
                render(scene, camera, settings, mode == Mode::kReference ? 16 : 1, kWidth, kHeight, mode, seed);
            images.push_back({kWidth, kHeight, {}});
            for (const gpu::vec3& pixel : picture.pixels)
                images.back().rgb.insert(images.back().rgb.end(), {pixel.x, pixel.y, pixel.z});
        }
        return images;
    }
};

TEST_F(ChangedLights, TablesThatThePlayerMakesAreTheCompilers)
{
    SceneBuilder builder;
    const package::Package package = opened(compile(builder, false));
    package::LightTable table(package);
    EXPECT_FALSE(table.rebuild()) << "a pmf is another";
    ASSERT_EQ(table.lights().size(), 6u);
    for (uint32_t i = 0; i < 6; ++i)
    {
        gpu::Light light = package.lights()[i];
        light.emission = float(i) * light.emission;
        table.set(i, light);
    }
    EXPECT_TRUE(table.rebuild());
    EXPECT_EQ(table.lights()[0].pmf, 0);
    for (uint32_t i = 0; i < 6; ++i)
        table.set(i, package.lights()[i]);
    table.rebuild();
    EXPECT_TRUE(equalBytes(table.lights(), package.lights())) << "what has changed does not come back";
    EXPECT_TRUE(equalBytes(table.aliases(), package.lightAliases()));
}

TEST_F(ChangedLights, DeviceHasThemWithTheProbabilitiesOfTheirPower)
{
    SceneBuilder builder;
    for (int i = 0; i < 4; ++i)
        builder.light(pointLight(1), {{"translation", {i, 1, 0}}});
    builder.floor(6, 0, builder.material(lambert(0.5)));
    const auto scene = load(builder.compile());
    std::vector<ChangedLight> changed;
    for (const uint32_t i : {3u, 1u, 0u}) // to 5, 1, 0 and 2 of 8
    {
        changed.push_back({i, scene->lights()[i]});
        const float power = i == 3 ? 2 : i == 1 ? 0 : 5;
        changed.back().light.emission = {power, power, power};
        changed.back().light.p0.y = 2;
    }
    submit(*scene, [&](Recorder& rec) { scene->setLights(rec, changed); });
    const auto lights = device().download<gpu::Light>(scene->buffer(gpu::kLightsBinding), 4);
    const auto aliases = device().download<gpu::AliasEntry>(scene->buffer(gpu::kLightAliasesBinding), 4);
    EXPECT_TRUE(equalBytes(std::span<const gpu::Light>(lights), scene->lights()));
    std::vector<double> drawn(4);
    for (size_t i = 0; i < 4; ++i)
    {
        drawn[i] += double(aliases[i].threshold) / 4;
        drawn[aliases[i].alias] += (1 - double(aliases[i].threshold)) / 4;
    }
    const std::array<double, 4> expected{5.0 / 8, 0, 1.0 / 8, 2.0 / 8};
    for (size_t i = 0; i < 4; ++i)
    {
        EXPECT_NEAR(double(lights[i].pmf), expected[i], 1e-6) << i;
        EXPECT_NEAR(drawn[i], expected[i], 1e-6) << i;
        EXPECT_EQ(lights[i].p0.y, i == 2 ? 1 : 2) << i;
    }
    EXPECT_EQ(drawn[1], 0);
}

TEST_F(ChangedLights, ByTheRendererStartThePictureAnew)
{
    SceneBuilder builder;
    const auto scene = load(compile(builder, false));
    const Camera camera{
        .name = {}, .position = {0, 1.6f, 4.5f}, .forward = {0, -0.2f, -0.98f}, .up = {0, 0.98f, -0.2f}};
    Renderer edited(device(), *scene, Mode::kReference, kWidth, kHeight);
    Recorder rec(device());
    const auto show = [&](Renderer& renderer, std::span<const ChangedLight> changed)
    {
        rec.begin(scene->descriptorSet());
        renderer.changeLights(rec, *scene, changed);
        renderer.record(rec, camera, smallSettings(), 1);
        rec.submitAndWait();
        return renderer.sampleCount();
    };
    EXPECT_EQ(show(edited, {}), 1u);
    EXPECT_EQ(show(edited, {}), 2u);
    const auto before = edited.picture(device());
    std::vector<ChangedLight> changed{{0, scene->lights()[0]}, {1, scene->lights()[1]}};
    changed[0].light.emission = {};        // off
    changed[1].light.emission = {9, 3, 1}; // and another place and colour
    changed[1].light.p0 = {0, 2, 1};
    EXPECT_EQ(show(edited, changed), 1u);
    Renderer fresh(device(), *scene, Mode::kReference, kWidth, kHeight);
    EXPECT_EQ(show(fresh, {}), 1u);
    const auto now = edited.picture(device()), right = fresh.picture(device());
    EXPECT_TRUE(equalBytes(std::span<const gpu::vec3>(now), std::span<const gpu::vec3>(right)));
    EXPECT_FALSE(equalBytes(std::span<const gpu::vec3>(now), std::span<const gpu::vec3>(before)));
    EXPECT_EQ(show(edited, {}), 2u);
}

TEST_F(ChangedLights, ShineAsWhereTheSceneIsCompiledWithThem)
{
    SceneBuilder before, after;
    const auto path = compile(before, false), other = compile(after, true);
    const auto scene = load(path), expected = load(other);
    const package::Package from = opened(path), to = opened(other);
    ASSERT_EQ(from.lights().size(), 6u);
    ASSERT_EQ(to.lights().size(), 5u);
    uint32_t material = gpu::kNone;
    for (const gpu::BvhTriangle& t : from.bvhTriangles())
        if (t.triangle == from.lights()[4].triangle)
            material = t.material;
    submit(*scene,
           [&](Recorder& rec)
           {
               scene->setLights(rec, changes(from, to));
               scene->setEmission(rec, material, to.lights()[3].emission); // as its triangles show it
           });
    for (const Mode mode : {Mode::kDirect, Mode::kReference, Mode::kGi})
    {
        const WelchResult result = welch(pictures(*scene, mode), pictures(*expected, mode));
        EXPECT_FALSE(result.differ()) << "mode " << int(mode) << ": p " << result.smallest.p << " of "
                                      << result.smallest.difference << " in tile " << result.smallest.tile_x << " "
                                      << result.smallest.tile_y;
    }
}
} // namespace
