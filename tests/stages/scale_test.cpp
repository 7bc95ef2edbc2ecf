// Where rays start and end, at every scale: what rounding needs and no more.
#include "tests/stages/closed_form.h"

#include <cmath>

namespace
{
constexpr double kAlbedo = 0.5;

class RayEnds : public ClosedForm
{
protected:
    /// A grey floor under a point light of 4 h^2 cd at height h, and a square of 0.5 m `gap` below the light.
    void expectShielded(double height, double gap)
    {
        SceneBuilder builder;
        builder.floor(float(height), 0, builder.material(lambert(kAlbedo)));
        builder.quad({-0.25f, float(height - gap), 0.25f}, {0.5f, 0, 0}, {0, 0, -0.5f},
                     builder.material(lambert(kAlbedo)));
        builder.light({{"type", "point"}, {"intensity", 4 * height * height}}, {{"translation", {0, height, 0}}});
        const auto scene = load(builder.compile());
        for (const float x : {0.0f, 0.3f})
            expectBoth(fmt::format("{} m up, shield {} mm below, {} of the height aside", height, 1000 * gap, x),
                       *scene, viewOf({x * float(height), 0, 0}, {0.3f, 1, 0.2f}), grey(0), {.depth = 2});
    }
};

TEST_F(RayEnds, AShieldCloseToALampShadowsIt)
{
    expectShielded(3, 0.001);
    expectShielded(30, 0.002);
    expectShielded(60, 0.002);
    expectShielded(200, 0.01);
}

/// A lamp exactly on a ceiling lights the floor as if there were no ceiling.
TEST_F(RayEnds, AFlushLampIsNotShadowedByWhatItLiesOn)
{
    const gpu::vec3 slanted_u = normalize({1, 0.37f, 0.11f}), slanted_v = normalize(cross({0.2f, 1, 0.3f}, slanted_u));
    struct Placed
    {
        const char* name;
        gpu::vec3 center, u, v; // of the floor; its front: u x v
    };
    for (const Placed& place : {Placed{"level", {0, 0, 0}, {1, 0, 0}, {0, 0, -1}},
                                {"slanted", {13.7f, 2.3f, -8.9f}, slanted_u, slanted_v},
                                {"slanted, 1 km away", {700, 300, -640}, slanted_u, slanted_v}})
    {
        SceneBuilder builder;
        const int grey_ = builder.material(lambert(kAlbedo)), black = builder.material(lambert(0));
        const gpu::vec3 up = normalize(cross(place.u, place.v)), lamp = place.center + 2.0f * up;
        const auto square = [&](gpu::vec3 center, float side, int material)
        { builder.quad(center + -side / 2 * place.u + -side / 2 * place.v, side * place.u, side * place.v, material); };
        square(place.center, 8, grey_);
        square(lamp, 8, black);
        square(lamp + 0.37f * place.u, 3, black); // that of another storey, drawn into the same plane
        builder.light({{"type", "point"}, {"intensity", 100}}, {{"translation", {lamp.x, lamp.y, lamp.z}}});
        const auto scene = load(builder.compile());
        for (const float x : {0.0f, 2.0f})
            expectBoth(fmt::format("{}, {} m aside", place.name, x), *scene,
                       viewOf(inPackage(place.center + x * place.u), up, 1, 0.01f),
                       grey(kAlbedo / kPi * 100 * 2 / std::pow(4 + double(x) * x, 1.5)), {.side = 32, .depth = 2});
    }
}

/// A room of single sheets in the sun and a white sky, a smooth ball of few facets half in its wall. Nothing gets in.
struct DarkRoom
{
    float scale;
    gpu::vec3 at;
    bool ground; // 20 km wide, the room stands on it
};

class Dark : public RayEnds, public testing::WithParamInterface<DarkRoom>
{
};

TEST_P(Dark, RoomsStayBlack)
{
    const auto& [scale, at, ground] = GetParam();
    SceneBuilder builder;
    const int white = builder.material(lambert(0.9));
    const auto place = [&](gpu::vec3 p) { return at + scale * p; };
    builder.box(place({-1, 0, -1}), place({1, 2, 1}), white, true);
    builder.sphere(place({0.8f, 0.5f, -0.1f}), 0.3f * scale, 4, true, white);
    builder.sphere(place({0.2f, 0.2f, -0.9f}), 0.2f * scale, 5, true, white);
    if (ground)
        builder.quad(at + gpu::vec3{-10000, 0, 10000}, {20000, 0, 0}, {0, 0, -20000}, white);
    for (const double turn : {0.3, 0.6}) // suns, from above and two sides
        builder.light(
            {{"type", "directional"}, {"intensity", 10}},
            {{"rotation", {-std::sin(turn) * 0.8, std::cos(turn) * 0.6, -std::sin(turn) * 0.6, std::cos(turn) * 0.8}}});
    builder.environment({.width = 1, .height = 1, .rgb = {1, 1, 1}});
    const auto scene = load(builder.compile());
    const gpu::vec3 eye = place({-0.7f, 1.2f, 0.8f}), forward = normalize({1, -0.6f, -0.9f});
    const Camera camera{.name = "",
                        .position = inPackage(eye),
                        .forward = forward,
                        .up = normalize(cross(cross(forward, {0, 1, 0}), forward)),
                        .vertical_fov = 1.6f,
                        .orthographic_height = 0};
    for (const Mode mode : {Mode::kReference, Mode::kDirect})
    {
        const Picture picture =
            render(*scene, camera, {.reference_depth = 6}, mode == Mode::kReference ? 24 : 4, 48, 48, mode);
        uint32_t lit = 0;
        for (const gpu::vec3& pixel : picture.pixels)
            lit += pixel.x != 0 || pixel.y != 0 || pixel.z != 0;
        EXPECT_EQ(lit, 0u) << (mode == Mode::kReference ? "pixels of the reference" : "pixels of direct light");
    }
}

INSTANTIATE_TEST_SUITE_P(, Dark,
                         testing::Values(DarkRoom{1, {0, 0, 0}, false}, DarkRoom{1e-3f, {0, 0, 0}, false},
                                         DarkRoom{1e3f, {0, 0, 0}, false}, DarkRoom{1, {1000, -300, 700}, false},
                                         DarkRoom{1, {3, 0, 5}, true}));
} // namespace
