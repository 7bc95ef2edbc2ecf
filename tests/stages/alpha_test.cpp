// Surfaces that cover only part of what is behind them, and surfaces that lie exactly on each other.
#include "tests/stages/closed_form.h"

#include <cmath>

namespace
{
constexpr double kAlbedo = 0.5;

nlohmann::json withAlpha(const nlohmann::json& material, double alpha, const nlohmann::json& mode)
{
    nlohmann::json result = with(material, mode);
    result["pbrMetallicRoughness"]["baseColorFactor"][3] = alpha;
    return result;
}

const nlohmann::json kBlend = {{"alphaMode", "BLEND"}};
nlohmann::json mask(double cutoff)
{
    return {{"alphaMode", "MASK"}, {"alphaCutoff", cutoff}};
}

/// A horizontal pane 1 m above a floor, facing down, and 2 m above it a point light of 100 cd.
struct ShadowedFloor
{
    explicit ShadowedFloor(const nlohmann::json& pane)
    {
        builder.floor(4, 0, builder.material(lambert(kAlbedo)));
        builder.quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, builder.material(pane));
        builder.light({{"type", "point"}, {"intensity", 100}}, {{"translation", {0, 2, 0}}});
    }
    SceneBuilder builder;
};

/// A node's rotation that makes its light, which shines along -Z, shine along `direction`.
nlohmann::json turnedTo(gpu::vec3 direction)
{
    const double half = std::sqrt(2 * (1 - double(direction.z))); // the axis is -Z x direction
    return {direction.y / half, -direction.x / half, 0, half / 2};
}

class Alpha : public ClosedForm
{
protected:
    /// A pane that glows with 1 before a wall that glows with 2.
    void expectSeenThrough(const char* what, const nlohmann::json& pane, double want)
    {
        SceneBuilder builder;
        builder.quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, builder.material(emitter(2)));
        builder.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, builder.material(pane));
        const auto scene = load(builder.compile());
        expectBoth(what, *scene, viewOf({0, 0, 0}, {0.2f, 0.1f, 1}), grey(want),
                   {.side = 64, .sample_count = 64, .depth = 2});
    }

    void expectShadow(const char* what, const nlohmann::json& pane, double factor)
    {
        ShadowedFloor floor(pane);
        const auto scene = load(floor.builder.compile());
        const gpu::vec3 low{1, 0.5f, 0}; // below the pane
        expectBoth(fmt::format("{}, below the light", what), *scene, viewOf({0, 0, 0}, low, 0.5f),
                   grey(factor * kAlbedo / kPi * 100 / 4), {.depth = 2});
        expectBoth(fmt::format("{}, 1 m aside", what), *scene, viewOf({1, 0, 0}, low, 0.5f),
                   grey(factor * kAlbedo / kPi * 100 * 2 / std::pow(5, 1.5)), {.depth = 2});
    }
};

TEST_F(Alpha, BlendShowsWhatIsBehindByWhatItDoesNotCover)
{
    expectSeenThrough("alpha 0.4", withAlpha(emitter(1), 0.4, kBlend), 0.4 * 1 + 0.6 * 2);
    expectSeenThrough("alpha 0", withAlpha(emitter(1), 0, kBlend), 2);
    expectSeenThrough("alpha 1", withAlpha(emitter(1), 1, kBlend), 1);
    expectSeenThrough("alpha 0.4 but opaque", withAlpha(emitter(1), 0.4, {{"alphaMode", "OPAQUE"}}), 1);
}

TEST_F(Alpha, BlendShadowsByWhatItCovers)
{
    expectShadow("alpha 0.4", withAlpha(lambert(0), 0.4, kBlend), 0.6);
    expectShadow("alpha 1", withAlpha(lambert(0), 1, kBlend), 0);
}

TEST_F(Alpha, MaskIsThereOrNot)
{
    expectSeenThrough("alpha 0.4 below the cut-off", withAlpha(emitter(1), 0.4, mask(0.5)), 2);
    expectSeenThrough("alpha 0.6 above the cut-off", withAlpha(emitter(1), 0.6, mask(0.5)), 1);
    expectShadow("alpha 0.4 below the cut-off", withAlpha(lambert(0), 0.4, mask(0.5)), 1);
    expectShadow("alpha 0.6 above the cut-off", withAlpha(lambert(0), 0.6, mask(0.5)), 0);
}

/// A lamp of which 40 % are there gives 40 % of its light, whichever way the light is found.
TEST_F(Alpha, CoverageDimsWhatASurfaceGivesAsWhatItShows)
{
    const auto expectLit = [&](const char* what, const nlohmann::json& lamp, double share)
    {
        SceneBuilder builder;
        builder.floor(8, 0, builder.material(lambert(kAlbedo)));
        builder.quad({-0.5f, 0.5f, -0.5f}, {1, 0, 0}, {0, 0, 1}, builder.material(lamp));
        const auto scene = load(builder.compile());
        const double root =
            std::sqrt(2.0); // form factor of a 1 x 1 m square 0.5 m above its middle: corners at 45 degrees
        const double form_factor = 4 * 2 * (1 / root) * std::atan(1 / root) / (2 * kPi);
        expectBoth(what, *scene, viewOf({0, 0, 0}, {0.3f, 1, 0.2f}, 0.05f), grey(share * 4 * kAlbedo * form_factor),
                   {.side = 64, .sample_count = 200, .depth = 3});
    };
    expectLit("opaque", emitter(4), 1);
    expectLit("alpha 0.4", withAlpha(emitter(4), 0.4, kBlend), 0.4);
    expectLit("masked away", withAlpha(emitter(4), 0.4, mask(0.5)), 0);
}

/// Half of a lamp is cut away by its texture: the floor gets the other half's light, and a point light goes through the
/// hole.
TEST_F(Alpha, MaskTextureCutsALampAndItsShadow)
{
    SceneBuilder builder;
    builder.floor(8, 0, builder.material(lambert(kAlbedo)));
    // Filtered and repeated, alpha is below one half exactly where u < 0.5.
    const int half = builder.texture(2, 1, {255, 255, 255, 0, 255, 255, 255, 255});
    const nlohmann::json textured = {{"alphaMode", "MASK"},
                                     {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", half}}}}}};
    builder.quad({-1, 1, -0.5f}, {2, 0, 0}, {0, 0, 1}, builder.material(with(emitter(4), textured)));
    builder.light({{"type", "point"}, {"intensity", 100}}, {{"translation", {0, 2, 0}}});
    const auto scene = load(builder.compile());
    for (const float x : {-0.8f, 0.8f})
    {
        const auto corner = [](double a) // of a rectangle a x 0.5 m, 1 m above its corner
        {
            const double b = 0.5, root_a = std::sqrt(1 + a * a), root_b = std::sqrt(1 + b * b);
            return (a / root_a * std::atan(b / root_a) + b / root_b * std::atan(a / root_b)) / (2 * kPi);
        };
        const double form_factor = 2 * (x < 0 ? corner(1 - x) - corner(-x) : corner(1 - x) + corner(x));
        // The ray to the point light crosses the lamp's plane half way, at x / 2.
        const double point = x < 0 ? 100 * 2 / std::pow(4 + double(x) * x, 1.5) : 0;
        expectBoth(fmt::format("{} m", x), *scene, viewOf({x, 0, 0}, {0.3f, 1, 0.2f}, 0.05f),
                   grey(kAlbedo * (4 * form_factor + point / kPi)), {.side = 64, .sample_count = 128, .depth = 3});
    }
}

/// The same floor stored twice, once with each winding, is one floor: no ray that leaves it may meet the other copy.
TEST_F(Alpha, CoincidentFacesAreLitAsOne)
{
    struct Placed
    {
        const char* name;
        gpu::vec3 center, u, v; // front: u x v
    };
    const gpu::vec3 slanted_u = 4.0f * normalize({1, 0.37f, 0.11f}),
                    slanted_v = 4.0f * normalize(cross({0.2f, 1, 0.3f}, slanted_u));
    for (const Placed& place : {Placed{"level", {0, 0, 0}, {4, 0, 0}, {0, 0, -4}},
                                {"level, 7 m up", {0.3f, 7.1f, -3.7f}, {4, 0, 0}, {0, 0, -4}},
                                {"slanted", {13.7f, 2.3f, -8.9f}, slanted_u, slanted_v}})
    {
        SceneBuilder builder;
        const int diffuse = builder.material(lambert(kAlbedo));
        const gpu::vec3 corner = place.center + -0.5f * place.u + -0.5f * place.v;
        builder.quad(corner, place.u, place.v, diffuse);
        builder.quad(corner, place.v, place.u, diffuse);
        const gpu::vec3 normal = normalize(cross(place.u, place.v));
        for (const float side : {1.0f, -1.0f}) // 60 degrees from the normal
        {
            const gpu::vec3 travels = normalize(-side * normal + std::sqrt(3.0f) * normalize(place.u));
            builder.light({{"type", "directional"}, {"intensity", side > 0 ? 10 : 5}},
                          {{"rotation", turnedTo(travels)}});
        }
        const auto scene = load(builder.compile());
        for (const float side : {1.0f, -1.0f})
        {
            // Pictures 2.8 m wide, so that many points of both triangles are tried.
            const double want = kAlbedo / kPi * (side > 0 ? 10 : 5) * 0.5;
            expectBoth(fmt::format("{}, side {}", place.name, side), *scene,
                       viewOf(place.center, side * normal, 1, 2.8f), grey(want),
                       {.side = 32, .sample_count = 128, .depth = 8});
        }
    }
}
} // namespace
