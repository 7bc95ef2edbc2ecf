// Emissive quads: what they show, and what they give a floor by the exact form factor.
#include "tests/stages/closed_form.h"

#include <cmath>

namespace
{
constexpr double kAlbedo = 0.5, kRadiance = 4;

/// Form factor of a rectangle a x b, parallel to a small element at distance c below one of its corners
/// (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-3).
double cornerFormFactor(double a, double b, double c)
{
    const double x = a / c, y = b / c, root_x = std::sqrt(1 + x * x), root_y = std::sqrt(1 + y * y);
    return (x / root_x * std::atan(y / root_x) + y / root_y * std::atan(x / root_y)) / (2 * kPi);
}

/// The same with the corner at (0, 0) and the rectangle's far corner at (a, b), either of which may be negative.
double signedFormFactor(double a, double b, double c)
{
    return std::copysign(1.0, a * b) * cornerFormFactor(std::abs(a), std::abs(b), c);
}

/// A 1 x 0.6 m rectangle about (0, distance, 0) seen from (x, 0, z).
double rectangleFormFactor(double x, double z, double distance)
{
    const double x0 = -0.5 - x, x1 = 0.5 - x, z0 = -0.3 - z, z1 = 0.3 - z;
    return signedFormFactor(x1, z1, distance) - signedFormFactor(x0, z1, distance) -
           signedFormFactor(x1, z0, distance) + signedFormFactor(x0, z0, distance);
}

/// The rectangle faces the floor.
void addLamp(SceneBuilder& builder, float height, const nlohmann::json& material)
{
    builder.quad({-0.5f, height, -0.3f}, {1, 0, 0}, {0, 0, 0.6f}, builder.material(material));
}

TEST_F(ClosedForm, EmissiveQuadShowsItsRadianceInFrontAndNothingBehind)
{
    SceneBuilder builder;
    const nlohmann::json colored = with(emitter(kRadiance), {{"emissiveFactor", {1, 0.5, 0.25}}});
    builder.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, builder.material(colored)); // faces +Z
    builder.quad({4, -1, 0}, {2, 0, 0}, {0, 2, 0}, builder.material(with(colored, {{"doubleSided", true}})));
    const auto scene = load(builder.compile());
    const Rgb emitted{kRadiance, kRadiance / 2, kRadiance / 4};
    expectBoth("front", *scene, viewOf({0, 0, 0}, {0.5f, 0.2f, 1}), emitted, {});
    expectBoth("back", *scene, viewOf({0, 0, 0}, {0.5f, 0.2f, -1}), grey(0), {});
    expectBoth("double-sided front", *scene, viewOf({5, 0, 0}, {0, 0, 1}), emitted, {});
    expectBoth("double-sided back", *scene, viewOf({5, 0, 0}, {0, 0, -1}), emitted, {});
}

TEST_F(ClosedForm, RectangleLightsAFloorByItsFormFactor)
{
    for (const float distance : {2.0f, 0.5f})
    {
        SceneBuilder builder;
        builder.floor(8, 0, builder.material(lambert(kAlbedo)));
        addLamp(builder, distance, emitter(kRadiance));
        const auto scene = load(builder.compile());
        for (const gpu::vec2 at : {gpu::vec2{0, 0}, {0.45f, -0.2f}, {1.5f, 0.7f}})
            expectBoth(fmt::format("{} m below, ({}, {})", distance, at.x, at.y), *scene,
                       viewOf({at.x, 0, at.y}, {0.3f, 1, 0.2f}, 0.05f),
                       grey(kAlbedo * kRadiance * rectangleFormFactor(at.x, at.y, distance)),
                       {.side = 32, .sample_count = 256, .depth = 3});
    }
}

/// Rays start 256 roundings off their surface: 0.5 mm at 30 m from the origin. That must not carry a shadow ray into
/// the lamp that it samples. (What is left is the light half a millimetre higher; hence no heights beyond.)
TEST_F(ClosedForm, ALampCloseToAFloorLightsItAtAnyHeight)
{
    constexpr float kGap = 0.1f;
    for (const float height : {0.0f, 1.0f, 30.0f})
    {
        SceneBuilder builder;
        builder.floor(8, height, builder.material(lambert(kAlbedo)));
        addLamp(builder, height + kGap, emitter(kRadiance));
        const auto scene = load(builder.compile());
        const double gap = double(height + kGap) - double(height); // as single precision has it
        for (const gpu::vec2 at : {gpu::vec2{0, 0}, {0.45f, -0.2f}})
            expectBoth(fmt::format("{} m up, ({}, {})", height, at.x, at.y), *scene,
                       viewOf({at.x, height, at.y}, {0.3f, 1, 0.2f}, 0.05f),
                       grey(kAlbedo * kRadiance * rectangleFormFactor(at.x, at.y, gap)),
                       {.side = 32, .sample_count = 192, .depth = 3});
    }
}

TEST_F(ClosedForm, DoubleSidedRectangleLightsBothItsSidesAlike)
{
    SceneBuilder builder;
    const int grey_diffuse = builder.material(lambert(kAlbedo));
    builder.floor(8, 0, grey_diffuse);
    builder.quad({-4, 1, -4}, {8, 0, 0}, {0, 0, 8}, grey_diffuse); // a ceiling, facing down
    addLamp(builder, 0.5f, with(emitter(kRadiance), {{"doubleSided", true}}));
    const auto scene = load(builder.compile());
    // Without light from wall to wall: that has no simple formula.
    const Rgb want = grey(kAlbedo * kRadiance * rectangleFormFactor(0, 0, 0.5));
    const ClosedForm::Sampling sampling{.side = 32, .sample_count = 128, .depth = 2};
    expectBoth("floor", *scene, viewOf({0, 0, 0}, {0.3f, 1, 0.2f}, 0.05f), want, sampling);
    expectBoth("ceiling", *scene, viewOf({0, 1, 0}, {0.3f, -1, 0.2f}, 0.05f), want, sampling);
}

TEST_F(ClosedForm, SingleSidedRectangleLeavesWhatIsBehindItDark)
{
    SceneBuilder builder;
    builder.floor(8, 0, builder.material(lambert(kAlbedo)));
    builder.quad({-0.5f, 0.5f, 0.3f}, {1, 0, 0}, {0, 0, -0.6f}, builder.material(emitter(kRadiance))); // faces up
    const auto scene = load(builder.compile());
    expectBoth("below its back", *scene, viewOf({0, 0, 0}, {0.3f, 1, 0.2f}, 0.05f), grey(0), {.sample_count = 64});
}

/// In a closed box whose walls all emit Le and reflect `albedo`, light is the same everywhere: Le / (1 - albedo).
TEST_F(ClosedForm, FurnaceHasTheSameLightEverywhere)
{
    for (const double albedo : {0.5, 0.8})
    {
        SceneBuilder builder;
        const nlohmann::json glowing = with(lambert(albedo), {{"emissiveFactor", {1, 0.5, 0.1}}});
        builder.box({-1, -0.5f, -1.5f}, {1, 0.5f, 1.5f}, builder.material(glowing), true);
        const auto scene = load(builder.compile());
        const Camera inside{.name = "",
                            .position = {0.3f, 0.1f, 0.4f},
                            .forward = normalize({1, -0.2f, -1}),
                            .up = {0, 1, 0},
                            .vertical_fov = 1.5f};
        const double all = 1 / (1 - albedo), first = 1 + albedo; // direct mode ends after one reflection
        const ClosedForm::Sampling sampling{.side = 32, .sample_count = albedo < 0.6 ? 64u : 320u, .depth = 64};
        expect(fmt::format("albedo {}", albedo), *scene, inside, Mode::kReference, {all, all / 2, all / 10}, sampling);
        expect(fmt::format("albedo {}", albedo), *scene, inside, Mode::kDirect, {first, first / 2, first / 10},
               sampling);
    }
}
} // namespace
