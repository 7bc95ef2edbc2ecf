// Glass: thin panes, slabs with and without absorption, spheres.
#include "tests/stages/closed_form.h"

#include <cmath>

namespace
{
constexpr double kAlbedo = 0.5;
constexpr Rgb kTint{0.8, 0.6, 0.4};

nlohmann::json glass(const Rgb& color, double transmission, double roughness = 0)
{
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {color[0], color[1], color[2], 1}},
              {"metallicFactor", 0},
              {"roughnessFactor", roughness}}},
            {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", transmission}}}}}};
}

nlohmann::json volume(const nlohmann::json& attenuation = nlohmann::json::object())
{
    return {{"extensions", {{"KHR_materials_volume", with({{"thicknessFactor", 1}}, attenuation)}}}};
}

/// Unpolarised reflectance of an interface from air into ior 1.5.
double fresnel(double cosine)
{
    constexpr double kIor = 1.5;
    const double cosine_t = std::sqrt(1 - (1 - cosine * cosine) / (kIor * kIor));
    const double s = (cosine - kIor * cosine_t) / (cosine + kIor * cosine_t);
    const double p = (kIor * cosine - cosine_t) / (kIor * cosine + cosine_t);
    return (s * s + p * p) / 2;
}

Rgb scaled(const Rgb& color, double factor)
{
    return {color[0] * factor, color[1] * factor, color[2] * factor};
}

TEST_F(ClosedForm, ThinPaneLetsThroughWhatItDoesNotReflect)
{
    for (const double transmission : {1.0, 0.5})
    {
        SceneBuilder builder;
        builder.quad({-10, -10, -1}, {20, 0, 0}, {0, 20, 0}, builder.material(emitter(2)));
        builder.quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}, builder.material(glass(kTint, transmission)));
        const auto scene = load(builder.compile());
        for (const double degrees : {0.0, 60.0})
        {
            const double angle = degrees * kDegree;
            expectBoth(fmt::format("transmission {}, {} degrees", transmission, degrees), *scene,
                       viewOf({0, 0, 0}, {float(std::sin(angle)), 0, float(std::cos(angle))}),
                       scaled(kTint, 2 * transmission * (1 - fresnel(std::cos(angle)))),
                       {.side = 64, .sample_count = 64, .depth = 2});
        }
    }
}

TEST_F(ClosedForm, ThinPaneTintsTheLightBelowIt)
{
    SceneBuilder builder;
    builder.floor(8, 0, builder.material(lambert(kAlbedo)));
    builder.floor(8, 1, builder.material(glass(kTint, 1)));
    builder.light({{"type", "point"}, {"intensity", 100}}, {{"translation", {0, 2, 0}}});
    const auto scene = load(builder.compile());
    for (const float x : {0.0f, 1.0f, 3.0f})
    {
        const double distance2 = 4 + double(x) * x, cosine = 2 / std::sqrt(distance2);
        const double lit = kAlbedo / kPi * 100 * cosine / distance2 * (1 - fresnel(cosine));
        expectBoth(fmt::format("{} m off axis", x), *scene, viewOf({x, 0, 0}, {0.1f, 1, 0.2f}, 0.5f),
                   scaled(kTint, lit), {.depth = 2});
    }
}

/// Both ways of finding an area light, by shadow rays and by chance, go through a pane alike.
TEST_F(ClosedForm, ThinPaneTintsTheLightOfALampBehindIt)
{
    SceneBuilder builder;
    builder.floor(8, 0, builder.material(lambert(kAlbedo)));
    builder.floor(8, 0.25f, builder.material(glass(kTint, 1)));
    builder.quad({-0.5f, 0.5f, -0.5f}, {1, 0, 0}, {0, 0, 1}, builder.material(emitter(4)));
    const auto scene = load(builder.compile());
    double sum = 0; // of (1 - F) cos^2 / (pi d^2) over the lamp
    constexpr int kSteps = 512;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k)
        {
            const double x = (i + 0.5) / kSteps - 0.5, z = (k + 0.5) / kSteps - 0.5, distance2 = x * x + z * z + 0.25;
            const double cosine = 0.5 / std::sqrt(distance2);
            sum += (1 - fresnel(cosine)) * cosine * cosine / (kPi * distance2 * kSteps * kSteps);
        }
    // Depth 3: the pane counts as a vertex of the way up; light between floor and pane would need four.
    const ClosedForm::Sampling sampling{.side = 32, .sample_count = 256, .depth = 3};
    const Camera below_pane = viewOf({0, 0, 0}, {0.3f, 1, 0.2f}, 0.1f);
    expect("lamp", *scene, below_pane, Mode::kReference, scaled(kTint, 4 * kAlbedo * sum), sampling);
    expect("lamp", *scene, below_pane, Mode::kDirect, scaled(kTint, 4 * kAlbedo * sum), sampling);
}

/// A slab of ior 1.5 and 1 m thickness before a wall that glows with 1; light to and fro between its faces adds up.
TEST_F(ClosedForm, SlabOfGlassPassesTheSeriesOfItsReflections)
{
    const double reflectance = 0.04;
    const auto passed = [&](double inside) // `inside`: what absorption leaves of one crossing
    { return (1 - reflectance) * (1 - reflectance) * inside / (1 - reflectance * reflectance * inside * inside); };
    const auto expectSlab = [&](const char* what, const nlohmann::json& material, const Rgb& want)
    {
        SceneBuilder builder;
        builder.quad({-10, -10, -2}, {20, 0, 0}, {0, 20, 0}, builder.material(emitter(1)));
        builder.box({-10, -10, -1}, {10, 10, 0}, builder.material(material));
        const auto scene = load(builder.compile());
        expectBoth(what, *scene, viewOf({0, 0, 0}, {0, 0, 1}), want, {.side = 64, .sample_count = 64, .depth = 16});
    };
    EXPECT_NEAR(passed(1), 0.923077, 1e-6);
    expectSlab("clear", with(glass(grey(1), 1), volume()), grey(passed(1)));
    const nlohmann::json attenuation = {{"attenuationColor", {0.5, 0.25, 0.8}}, {"attenuationDistance", 0.5}};
    expectSlab("absorbing", with(glass(grey(1), 1), volume(attenuation)), {passed(0.25), passed(0.0625), passed(0.64)});
}

/// In a uniformly white world a body that absorbs nothing cannot be seen.
TEST_F(ClosedForm, FacetedGlassBallVanishesInAWhiteWorld)
{
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1, 12, false, builder.material(with(glass(grey(1), 1), volume())));
    builder.environment({.width = 1, .height = 1, .rgb = {1, 1, 1}});
    const auto scene = load(builder.compile());
    const Camera all = viewOf({0, 0, 0}, {0.2f, 0.3f, 1}, 2, 2);
    expect("ball", *scene, all, Mode::kReference, grey(1), {.side = 64, .sample_count = 144, .depth = 128});
}

/// Normals that are not the facets' own, and microfacets that scatter only once, lose light; neither may make any.
TEST_F(ClosedForm, SmoothAndRoughGlassBallsMakeNoLight)
{
    for (const double roughness : {0.0, 0.1, 0.3, 0.6})
    {
        SceneBuilder builder;
        builder.sphere({0, 0, 0}, 1, 48, true, builder.material(with(glass(grey(1), 1, roughness), volume())));
        builder.environment({.width = 1, .height = 1, .rgb = {1, 1, 1}});
        const auto scene = load(builder.compile());
        const Camera inner = viewOf({0, 0, 0}, {0.2f, 0.3f, 1}, 2, 1.2f);
        const Estimate got = measure(fmt::format("roughness {}", roughness), *scene, inner, Mode::kReference,
                                     {.side = 32, .sample_count = 64, .depth = 64});
        for (size_t c = 0; c < 3; ++c)
        {
            EXPECT_LE(got.mean[c], 1 + 5 * got.standard_error[c] + 1e-6);
            EXPECT_GT(got.mean[c], 0.5);
        }
    }
}
} // namespace
