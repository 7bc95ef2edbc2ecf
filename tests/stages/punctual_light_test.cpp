// Point, spot and directional lights over a diffuse floor: no sampling is involved, so the formulas hold to rounding.
#include "tests/stages/closed_form.h"

#include <cmath>

namespace
{
constexpr double kAlbedo = 0.5;

/// A grey floor at height 0 under one light.
struct LitFloor
{
    LitFloor(const nlohmann::json& light, const nlohmann::json& node,
             const nlohmann::json& parent = nlohmann::json::object())
    {
        builder.floor(20, 0, builder.material(lambert(kAlbedo)));
        builder.light(light, node, parent);
    }
    SceneBuilder builder;
};

const nlohmann::json kDownwards = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}; // turns -Z, the way lights shine, to -Y

Rgb reflected(double irradiance)
{
    return grey(kAlbedo / kPi * irradiance);
}

TEST_F(ClosedForm, PointLightFallsOffWithTheSquareOfDistanceAndTheCosine)
{
    LitFloor floor({{"type", "point"}, {"intensity", 100}}, {{"translation", {0, 2, 0}}});
    const auto scene = load(floor.builder.compile());
    for (const float x : {0.0f, 1.0f, 3.0f, 8.0f})
    {
        const double distance2 = 4 + double(x) * x;
        const double cosine = 2 / std::sqrt(distance2);
        expectBoth(fmt::format("{} m off axis", x), *scene, viewOf({x, 0, 0}, {0.3f, 1, 0.2f}),
                   reflected(100 * cosine / distance2), {});
    }
}

TEST_F(ClosedForm, PointLightHasItsColourAndIntensityOneByDefault)
{
    LitFloor floor({{"type", "point"}, {"color", {1, 0.5, 0.25}}}, {{"translation", {0, 2, 0}}});
    const auto scene = load(floor.builder.compile());
    const double irradiance = kAlbedo / kPi / 4;
    expectBoth("1 cd", *scene, viewOf({0, 0, 0}, {0, 1, 0}), {irradiance, irradiance / 2, irradiance / 4}, {});
}

TEST_F(ClosedForm, PointLightBelowAScaledNodeKeepsItsIntensity)
{
    // The parent's scale moves the light to height 2 and must change nothing else.
    LitFloor floor({{"type", "point"}, {"intensity", 100}}, {{"translation", {0, 0.5, 0}}}, {{"scale", {4, 4, 4}}});
    const auto scene = load(floor.builder.compile());
    expectBoth("scaled by 4", *scene, viewOf({0, 0, 0}, {0, 1, 0}), reflected(25), {});
}

TEST_F(ClosedForm, SeveralLightsAddUp)
{
    LitFloor floor({{"type", "point"}, {"intensity", 100}}, {{"translation", {0, 2, 0}}});
    floor.builder.light({{"type", "point"}, {"intensity", 50}}, {{"translation", {1, 2, 0}}});
    floor.builder.light({{"type", "directional"}, {"intensity", 3}}, {{"rotation", kDownwards}});
    const auto scene = load(floor.builder.compile());
    const double irradiance = 25 + 50 * 2 / std::pow(5, 1.5) + 3;
    expectBoth("three lights", *scene, viewOf({0, 0, 0}, {0, 1, 0}), reflected(irradiance),
               {.side = 16, .sample_count = 256});
}

TEST_F(ClosedForm, SpotLightFadesFromInnerToOuterConeAsGltfSays)
{
    constexpr double kInner = 0.3, kOuter = 0.6;
    LitFloor floor(
        {{"type", "spot"}, {"intensity", 100}, {"spot", {{"innerConeAngle", kInner}, {"outerConeAngle", kOuter}}}},
        {{"translation", {0, 2, 0}}, {"rotation", kDownwards}});
    const auto scene = load(floor.builder.compile());
    for (const double angle : {0.0, 0.2, 0.29, 0.35, 0.45, 0.55, 0.62, 1.2})
    {
        const double cosine = std::cos(angle);
        // KHR_lights_punctual, "Inner and Outer Cone Angles"
        const double scale = 1 / std::max(0.001, std::cos(kInner) - std::cos(kOuter));
        const double fade = std::clamp(cosine * scale - std::cos(kOuter) * scale, 0.0, 1.0);
        const double irradiance = 100 * fade * fade * cosine * cosine * cosine / 4;
        expectBoth(fmt::format("{} rad off axis", angle), *scene,
                   viewOf({0, 0, float(2 * std::tan(angle))}, {0.3f, 1, 0.2f}), reflected(irradiance), {});
    }
}

TEST_F(ClosedForm, SpotLightWithoutAnglesFadesFromItsAxisToAnEighthTurn)
{
    LitFloor floor({{"type", "spot"}, {"intensity", 100}, {"spot", nlohmann::json::object()}},
                   {{"translation", {0, 2, 0}}, {"rotation", kDownwards}});
    const auto scene = load(floor.builder.compile());
    for (const double angle : {0.0, 0.4, 0.7, 0.8})
    {
        const double cosine = std::cos(angle), rim = std::sqrt(0.5);
        const double fade = std::clamp((cosine - rim) / (1 - rim), 0.0, 1.0);
        expectBoth(fmt::format("{} rad off axis", angle), *scene, viewOf({float(2 * std::tan(angle)), 0, 0}, {0, 1, 0}),
                   reflected(100 * fade * fade * cosine * cosine * cosine / 4), {});
    }
}

TEST_F(ClosedForm, DirectionalLightGivesItsIlluminanceTimesTheCosine)
{
    for (const double angle : {0.0, 60 * kDegree})
    {
        const double half = (angle - kPi / 2) / 2; // about X: -Z to straight down, then tilted by `angle`
        LitFloor floor({{"type", "directional"}, {"intensity", 10}},
                       {{"rotation", {std::sin(half), 0, 0, std::cos(half)}}});
        const auto scene = load(floor.builder.compile());
        expectBoth(fmt::format("{:.0f} degrees", angle / kDegree), *scene, viewOf({0.5f, 0, 0.5f}, {0, 1, 0}),
                   reflected(10 * std::cos(angle)), {});
    }
}
} // namespace
