// Rooms of single sheets in the sun, in mode gi: what light is outside stays there, whatever angle the sheets meet under and however
// far the scene reaches.
#include "tests/stages/gi_test.h"
#include "tests/stages/same_picture.h"

#include <cmath>

namespace
{
constexpr uint32_t kWidth = 40, kHeight = 24;

class Sheets : public GiTest
{
protected:
    /// Two sheets that meet a floor at 45 degrees, closed at both ends. @param window a gap in the left one
    static void addTent(SceneBuilder& builder, bool window)
    {
        const int white = builder.material(lambert(0.7));
        builder.quad({-2, 0, 3}, {4, 0, 0}, {0, 0, -6}, white);
        builder.quad({2, 0, 3}, {0, 0, -6}, {-2, 2, 0}, white);
        const float gap = window ? 1 : 0;
        builder.quad({-2, 0, 3}, {2, 2, 0}, {0, 0, -3 + gap}, white);
        builder.quad({-2, 0, -gap}, {2, 2, 0}, {0, 0, -3 + gap}, white);
        for (const float z : {-3.0f, 3.0f})
            builder.quad({-2, 0, z}, {4, 0, 0}, {0, 2, 0}, white);
        builder.light(
            {{"type", "directional"}, {"intensity", 20}},
            {{"rotation", {-std::sin(0.3) * 0.8, -std::cos(0.3) * 0.6, -std::sin(0.3) * 0.6, std::cos(0.3) * 0.8}}});
    }

    Camera camera() const
    {
        const gpu::vec3 forward = normalize({-0.35f, -0.25f, -1});
        return {.name = "",
                .position = inPackage({0.4f, 0.9f, 2.6f}),
                .forward = forward,
                .up = normalize(cross(cross(forward, {0, 1, 0}), forward)),
                .vertical_fov = 1.1f,
                .orthographic_height = 0};
    }
};

TEST_F(Sheets, SunOnATentLeavesItDark)
{
    SceneBuilder builder;
    addTent(builder, false);
    const auto scene = load(builder.compile());
    const Picture picture = renderGi(*scene, camera(), smallSettings(), 12, kWidth, kHeight);
    for (size_t i = 0; i < picture.pixels.size(); ++i)
        ASSERT_EQ(picture.pixels[i].y, 0) << "pixel " << i;
}

/// A triangle 10000 km away changes the bounds of the scene, and nothing that is seen.
TEST_F(Sheets, ATriangleFarAwayChangesNothing)
{
    constexpr uint32_t kSeeds = 5;
    std::vector<std::vector<ImageF>> pictures(2);
    for (const bool far : {false, true})
    {
        SceneBuilder builder;
        addTent(builder, true);
        if (far)
            builder.quad({1e7f, 0, 0}, {5, 0, 0}, {0, 5, 0}, builder.material(lambert(0.5)));
        const auto scene = load(builder.compile());
        for (uint32_t seed = 1; seed <= kSeeds; ++seed)
            pictures[far].push_back(
                imageOf(kWidth, kHeight,
                        renderGi(*scene, camera(), smallSettings(), 8, kWidth, kHeight, 10 * far + seed).pixels));
    }
    expectSamePicture("a triangle far away", pictures[0], pictures[1], 0.05);
}
} // namespace
