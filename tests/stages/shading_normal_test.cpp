// Normals that are not those of the triangles: smooth meshes of few facets, normal maps, and normals on the wrong side.
#include "tests/stages/closed_form.h"

#include <cmath>

namespace
{
constexpr double kAlbedo = 0.5;

class ShadingNormals : public ClosedForm
{
protected:
    /// A smooth ball in the sun from the side.
    Picture ball(int facets, const nlohmann::json& material, Mode mode)
    {
        SceneBuilder builder;
        builder.sphere({0, 0, 0}, 1, facets, true, builder.material(material));
        builder.light({{"type", "directional"}, {"intensity", 4}},
                      {{"rotation", {0, std::sin(0.75), 0, std::cos(0.75)}}});
        const auto scene = load(builder.compile());
        return render(*scene, viewOf({0, 0, 0}, {0, 0.2f, 1}, 3, 2.1f), {.reference_depth = 2}, 8, 96, 96, mode);
    }
};

/// Where light turns to shade, a ball of few facets is as dark as a fine one: no facet is cut out of the light.
TEST_F(ShadingNormals, TurnToShadeSmoothlyOnFewFacets)
{
    const Picture fine = ball(96, lambert(kAlbedo), Mode::kReference);
    for (const int facets : {5, 8, 12, 24})
    {
        const Picture covered = ball(facets, emitter(1), Mode::kReference); // a ball of few facets is smaller
        for (const Mode mode : {Mode::kReference, Mode::kDirect})
        {
            const Picture coarse = ball(facets, lambert(kAlbedo), mode);
            uint32_t band = 0, lost = 0;
            for (size_t i = 0; i < fine.pixels.size(); ++i)
            {
                const float right = fine.pixels[i].y, full = float(4 * kAlbedo / kPi);
                if (right < 0.08f * full || right > 0.47f * full || covered.pixels[i].y < 1)
                    continue;
                ++band;
                lost += coarse.pixels[i].y < right / 4;
            }
            fmt::print("  {} facets: {} of {} pixels are lost\n", facets, lost, band);
            EXPECT_GT(band, 500u);
            EXPECT_LE(lost, band / 100) << facets; // at the rim, where facets are seen edge-on
        }
    }
}

/// Matter without a mirror looks the same from everywhere, whichever way its normals and triangles face.
TEST_F(ShadingNormals, OnTheWrongSideMeanTheirOwn)
{
    SceneBuilder builder;
    builder.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, builder.material(lambert(kAlbedo)), {0, -1, 0});
    builder.light({{"type", "directional"}, {"intensity", 4}},
                  {{"rotation", {std::sin(-kPi / 6), 0, 0, std::cos(-kPi / 6)}}}); // 30 degrees off the normal
    const auto scene = load(builder.compile());
    for (const double degrees : {-80, -60, -30, 0, 30, 60, 80})
    {
        const double angle = degrees * kDegree;
        expectBoth(fmt::format("{} degrees", degrees), *scene,
                   viewOf({0, 0, 0}, {0, float(std::cos(angle)), float(std::sin(angle))}),
                   grey(kAlbedo / kPi * 4 * std::cos(30 * kDegree)), {.depth = 2});
    }
}

/// A mirror whose normal map tilts it by 30 degrees loses nothing of a white sky, from wherever it is seen.
TEST_F(ShadingNormals, TiltedMirrorsReflectAllOfAWhiteSky)
{
    SceneBuilder builder;
    const int map = builder.texture(1, 1, {191, 128, 238, 255}); // (0.5, 0, 0.866)
    builder.floor(4, 0,
                  builder.material({{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}},
                                    {"normalTexture", {{"index", map}}}}));
    builder.environment({.width = 1, .height = 1, .rgb = {1, 1, 1}});
    const auto scene = load(builder.compile());
    for (const double degrees : {-85, -60, -30, 0, 30, 60, 85})
    {
        const double angle = degrees * kDegree;
        expectBoth(fmt::format("{} degrees", degrees), *scene,
                   viewOf({0, 0, 0}, {float(std::sin(angle)), float(std::cos(angle)), 0}), grey(1),
                   {.side = 8, .sample_count = 4, .depth = 3});
    }
}
} // namespace
