// The terms of the reference: together they are the whole picture, and each holds its own paths only.
#include "shaders/lib/terms.h"
#include "tests/stages/closed_form.h"
#include "tests/stages/same_picture.h"

#include <cmath>
#include <numeric>

namespace
{
constexpr std::array<uint32_t, 5> kTerms{gpu::kTermEmission, gpu::kTermDirect, gpu::kTermCaustics, gpu::kTermIndirect,
                                         gpu::kTermGlossy};
constexpr std::array<const char*, 6> kNames{"all", "emission", "direct", "caustics", "indirect", "glossy"};
constexpr uint32_t kWidth = 48, kHeight = 40, kSamples = 8, kDepth = 16;

// ---- Scenes
// ----------------------------------------------------------------------------------------------------------

nlohmann::json metal(double roughness)
{
    return {{"pbrMetallicRoughness", {{"baseColorFactor", {0.9, 0.6, 0.3, 1}}, {"roughnessFactor", roughness}}}};
}

nlohmann::json plastic(double roughness, double albedo)
{
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {albedo, albedo / 2, albedo / 4, 1}},
              {"metallicFactor", 0},
              {"roughnessFactor", roughness}}}};
}

nlohmann::json glass(double roughness, double thickness)
{
    return {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", roughness}}},
            {"extensions",
             {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
              {"KHR_materials_volume", {{"thicknessFactor", thickness}}}}}};
}

/// A Lambert room of 2 m, open towards +z, with a lamp below its ceiling.
void emptyRoom(SceneBuilder& scene)
{
    const int wall = scene.material(lambert(0.6));
    scene.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, wall);
    scene.quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, wall);
    scene.quad({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, wall);
    scene.quad({-1, 0, 1}, {0, 0, -2}, {0, 2, 0}, wall);
    scene.quad({1, 0, -1}, {0, 0, 2}, {0, 2, 0}, wall);
    scene.quad({-0.3f, 1.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, scene.material(emitter(8)));
}

void mirrorBall(SceneBuilder& scene)
{
    scene.sphere({-0.5f, 0.4f, -0.3f}, 0.3f, 12, true, scene.material(metal(0)));
}

ImageF skyMap()
{
    ImageF map{.width = 16, .height = 8, .rgb = {}};
    for (uint32_t i = 0; i < map.width * map.height; ++i)
        map.rgb.insert(map.rgb.end(), {0.2f + 0.1f * float(i % 5), i == 37 ? 6.0f : 0.5f, 0.3f + 0.1f * float(i / 16)});
    return map;
}

/// Everything at once: every kind of lobe, a window pane, a blended sheet, an unlit picture and a textured sky.
std::filesystem::path fullRoom(SceneBuilder& scene)
{
    emptyRoom(scene);
    mirrorBall(scene);
    scene.sphere({0.5f, 0.4f, -0.3f}, 0.3f, 12, true, scene.material(metal(0.4)));
    scene.sphere({0, 0.9f, 0}, 0.25f, 12, true, scene.material(glass(0, 0.5)));
    scene.sphere({0.6f, 1.3f, -0.5f}, 0.25f, 12, true, scene.material(glass(0.3, 0.5)));
    scene.sphere({-0.6f, 1.3f, -0.5f}, 0.25f, 12, true, scene.material(plastic(0, 0.8)));
    scene.sphere({0, 0.25f, 0.3f}, 0.2f, 12, true, scene.material(plastic(0.5, 0.8)));
    scene.quad({-0.9f, 0.1f, 0.7f}, {0.8f, 0, 0}, {0, 1.2f, 0}, scene.material(glass(0, 0)));
    nlohmann::json sheet = with(lambert(0.5), {{"alphaMode", "BLEND"}, {"doubleSided", true}});
    sheet["pbrMetallicRoughness"]["baseColorFactor"] = {0.2, 0.4, 0.8, 0.4};
    scene.quad({0.2f, 0.1f, 0.6f}, {0.7f, 0, 0}, {0, 0.8f, 0}, scene.material(sheet));
    const nlohmann::json unlit = {{"KHR_materials_unlit", nlohmann::json::object()}};
    scene.quad({-0.2f, 1.3f, -0.9f}, {0.4f, 0, 0}, {0, 0.4f, 0}, scene.material({{"extensions", unlit}}));
    scene.environment(skyMap());
    return scene.compile();
}

const Camera kCamera{.name = "",
                     .position = {0, 1, 2.2f},
                     .forward = {0, 0, -1},
                     .up = {0, 1, 0},
                     .vertical_fov = 1.1f,
                     .orthographic_height = 0};

// ---- Pictures
// --------------------------------------------------------------------------------------------------------

std::vector<double> values(const Picture& picture)
{
    std::vector<double> all;
    for (const gpu::vec3& p : picture.pixels)
        all.insert(all.end(), {p.x, p.y, p.z});
    return all;
}

double sumOf(const std::vector<double>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0);
}

class Terms : public GpuTest
{
protected:
    std::vector<double> term(const SceneGpu& scene, uint32_t term, uint32_t samples = kSamples, uint32_t seed = 0)
    {
        return values(render(scene, kCamera, {.reference_depth = kDepth, .term = term}, samples, kWidth, kHeight,
                             Mode::kReference, seed));
    }

    /// Expects the terms of `bright` to hold light, and every other one none at all.
    void expectOnly(const SceneGpu& scene, const std::vector<uint32_t>& bright)
    {
        for (const uint32_t t : kTerms)
        {
            const double sum = sumOf(term(scene, t));
            if (std::ranges::find(bright, t) != bright.end())
                EXPECT_GT(sum, 0) << kNames[t];
            else
                EXPECT_EQ(sum, 0) << kNames[t];
        }
    }
};

TEST_F(Terms, SumToTheWholePictureUpToRounding)
{
    SceneBuilder builder;
    const auto scene = load(fullRoom(builder));
    const std::vector<double> all = term(*scene, gpu::kTermAll);
    std::vector<double> sum(all.size());
    for (const uint32_t t : kTerms)
    {
        const std::vector<double> part = term(*scene, t);
        EXPECT_GT(sumOf(part), 0) << kNames[t];
        EXPECT_GE(std::ranges::min(part), 0) << kNames[t];
        for (size_t i = 0; i < sum.size(); ++i)
            sum[i] += part[i];
    }
    // Nothing is negative, so every addition errs by half a unit in the last place of the result at most. A sample adds
    // up to two values a vertex, in the picture of all and again in those of terms; splitting a weight in two and
    // scaling sums costs a few roundings more.
    constexpr double kRounding = 0x1p-24, kSplitting = 16;
    constexpr double kTolerance = (2 * 2 * kDepth * kSamples + kSplitting) * kRounding;
    for (size_t i = 0; i < all.size(); ++i)
        ASSERT_NEAR(sum[i], all[i], kTolerance * all[i]) << "value " << i;
}

TEST_F(Terms, OfLambertSurfacesAreNeitherGlossyNorCaustics)
{
    SceneBuilder builder;
    emptyRoom(builder);
    const auto scene = load(builder.compile());
    expectOnly(*scene, {gpu::kTermEmission, gpu::kTermDirect, gpu::kTermIndirect});
}

TEST_F(Terms, OfLambertSurfacesAndAMirrorAreNotGlossy)
{
    SceneBuilder builder;
    emptyRoom(builder);
    mirrorBall(builder);
    const auto scene = load(builder.compile());
    expectOnly(*scene, {gpu::kTermEmission, gpu::kTermDirect, gpu::kTermCaustics, gpu::kTermIndirect});
}

TEST_F(Terms, OfSurfacesWithoutADiffuseLobeAreNeitherCausticsNorIndirect)
{
    SceneBuilder builder;
    for (const float x : {-0.6f, 0.6f})
        builder.sphere({x, 1, 0}, 0.5f, 12, true, builder.material(metal(0.4)));
    mirrorBall(builder);
    builder.environment(skyMap());
    const auto scene = load(builder.compile());
    expectOnly(*scene, {gpu::kTermEmission, gpu::kTermDirect, gpu::kTermGlossy});
}

TEST_F(Terms, OfOneConvexSurfaceAreWhatItGivesAndReceives)
{
    SceneBuilder builder;
    builder.sphere({0, 1, 0}, 0.8f, 12, true, builder.material(plastic(0.3, 0.8)));
    builder.environment(skyMap());
    const auto scene = load(builder.compile());
    expectOnly(*scene, {gpu::kTermEmission, gpu::kTermDirect});
}

TEST_F(Terms, CountLightThroughAThinPaneAsDirect)
{
    // The pane lies between lamp and floor: what it mirrors has been on the floor before.
    SceneBuilder builder;
    builder.floor(2, 0, builder.material(lambert(0.6)));
    builder.quad({-3, 1, 3}, {6, 0, 0}, {0, 0, -6}, builder.material(glass(0, 0)));
    builder.quad({-0.3f, 1.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, builder.material(emitter(8)));
    const auto scene = load(builder.compile());
    expectOnly(*scene, {gpu::kTermEmission, gpu::kTermDirect, gpu::kTermIndirect});
}

// ---- Against other ways to the same light
// ----------------------------------------------------------------------------

constexpr double kSigmas = 4.5;

TEST_F(Terms, EmissionAndDirectAreWhatTheDirectModeShows)
{
    constexpr uint32_t kLongChains = 64, kSeeds = 8;
    SceneBuilder builder;
    const auto scene = load(fullRoom(builder));
    const auto picture = [&](Mode mode, uint32_t term, uint32_t seed)
    {
        const Settings settings{.specular_depth = kLongChains, .reference_depth = kLongChains, .term = term};
        return imageOf(kWidth, kHeight,
                       render(*scene, kCamera, settings, kSamples, kWidth, kHeight, mode, seed).pixels);
    };
    std::vector<ImageF> direct, terms;
    for (uint32_t seed = 0; seed < kSeeds; ++seed)
    {
        direct.push_back(picture(Mode::kDirect, gpu::kTermAll, 3 * seed));
        terms.push_back(picture(Mode::kReference, gpu::kTermEmission, 3 * seed + 1));
        const ImageF part = picture(Mode::kReference, gpu::kTermDirect, 3 * seed + 2);
        for (size_t i = 0; i < part.rgb.size(); ++i)
            terms.back().rgb[i] += part.rgb[i];
    }
    expectSamePicture("emission and direct light", terms, direct, 0.005);
}

class SplitLobes : public Terms
{
protected:
    /// A plastic floor below a Lambert ceiling that a lamp lights from below. Paths: camera, floor, ceiling, lamp.
    Estimate measure(double albedo, uint32_t term)
    {
        SceneBuilder builder;
        builder.floor(2, 0, builder.material(plastic(0.5, albedo)));
        builder.quad({-2, 2, -2}, {4, 0, 0}, {0, 0, 4}, builder.material(lambert(0.7)));
        builder.quad({-1.5f, 1, 0.5f}, {1, 0, 0}, {0, 0, -1}, builder.material(emitter(20)));
        const auto scene = load(builder.compile());
        const Picture picture = render(*scene, viewOf({0, 0, 0}, {0.6f, 0.8f, 0}), {.reference_depth = 3, .term = term},
                                       512, 16, 16, Mode::kReference);
        const Estimate e = estimate(picture);
        fmt::print("albedo {}, {}: {:.5f} ({:.1e})\n", albedo, kNames[term], e.mean[0], e.standard_error[0]);
        return e;
    }

    static void expectRatio(const Estimate& a, const Estimate& b, size_t channel, double ratio)
    {
        const double scale_a = a.standard_error[channel], scale_b = ratio * b.standard_error[channel];
        EXPECT_LT(std::hypot(scale_a, scale_b), 0.01 * a.mean[channel]);
        EXPECT_NEAR(a.mean[channel], ratio * b.mean[channel], kSigmas * std::hypot(scale_a, scale_b));
    }
};

TEST_F(SplitLobes, GlossyLightDoesNotDependOnTheAlbedoBelow)
{
    expectRatio(measure(0, gpu::kTermGlossy), measure(0.9, gpu::kTermGlossy), 0, 1);
}

TEST_F(SplitLobes, IndirectLightIsInProportionToIt)
{
    const Estimate bright = measure(0.8, gpu::kTermIndirect), dark = measure(0.1, gpu::kTermIndirect);
    for (size_t channel = 0; channel < 3; ++channel)
        expectRatio(bright, dark, channel, 8);
    EXPECT_EQ(measure(0, gpu::kTermIndirect).mean, grey(0));
}
} // namespace
