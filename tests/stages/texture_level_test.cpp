// Which mip level of a texture a pixel shows: the one whose texels are as large as what the pixel covers of the
// surface.
#include "runtime/camera.h"
#include "runtime/stages/primary.h"
#include "tests/stages/gi_test.h"

#include <numbers>

namespace
{
constexpr uint32_t kSide = 48;  // pixels
constexpr double kTexels = 256; // across the wall
constexpr double kWallSide = 8; // metres
constexpr double kTexel = kWallSide / kTexels;

/// A wall of stripes a texel wide, black and white, which are even grey in every level but the finest: what contrast is
/// left of them gives the level, if that is between 0 and 1.
class TextureLevel : public GiTest
{
protected:
    void addWall(gpu::vec3 corner, gpu::vec3 edge_u, gpu::vec3 edge_v)
    {
        std::vector<uint8_t> stripes;
        for (uint32_t i = 0; i < kTexels * kTexels; ++i)
            stripes.insert(stripes.end(), {uint8_t(i % 2 * 255), uint8_t(i % 2 * 255), uint8_t(i % 2 * 255), 255});
        const int texture = builder_.texture(uint32_t(kTexels), uint32_t(kTexels), stripes);
        builder_.quad(corner, edge_u, edge_v,
                      builder_.material(
                          with(lambert(1), {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}})));
    }

    /// Lightest minus darkest of what is seen of the stripes, as a fraction of white.
    double contrast(const Camera& camera, uint32_t frame)
    {
        const auto scene = load(builder_.compile());
        const PrimaryStage stage(device(), *scene, kSide * kSide);
        const RayStage rays(device(), *scene);
        gpu::CameraParams view = cameraParams(camera, kSide, kSide);
        view.sample_count = 1;
        view.first_sample = frame;
        const Buffer emission = upload("test.emission", std::vector<gpu::vec3>(kSide * kSide));
        std::optional<SurfaceBuffers> out;
        submit(*scene, [&](Recorder& rec)
               { out.emplace(stage.record(rec, rays, {.camera = view, .specular_depth = 2, .emission = emission})); });
        float least = 1, most = 0;
        for (const gpu::DiffusePoint& p : contents<gpu::DiffusePoint>(out->diffuse_points, kSide * kSide))
            least = std::min(least, p.reflectance.x), most = std::max(most, p.reflectance.x);
        return double(most) - least;
    }

    /// @param texels across a square as large as what a pixel covers of the wall
    static double expected(double texels)
    {
        return 1 - std::clamp(std::log2(PrimaryStage::kTextureBlur * texels), 0.0, 1.0);
    }

    SceneBuilder builder_;
};

constexpr double kTolerance = 0.02; // brightest and darkest points are hit nearly; levels are blended in steps of 1/256

Camera cameraAt(gpu::vec3 position, gpu::vec3 forward, double vertical_fov, double orthographic_height)
{
    return {.name = "",
            .position = position,
            .forward = forward,
            .up = normalize(cross(cross(forward, {0, 1, 0}), forward)),
            .vertical_fov = float(vertical_fov),
            .orthographic_height = float(orthographic_height)};
}

TEST_F(TextureLevel, IsThatOfAPixelsPartOfTheWall)
{
    addWall({-4, -4, 0}, {8, 0, 0}, {0, 8, 0});
    for (const double texels : {1.0, 1.6, 2.2, 2.7, 4.0})
    {
        const double seen = texels * kTexel * kSide;
        EXPECT_NEAR(contrast(cameraAt({0, 0, 2}, {0, 0, -1}, 0, seen), 0), expected(texels), kTolerance)
            << texels << ", parallel";
        // From far away, for the footprint grows by a cosine towards the rim.
        const double fov = 0.05, distance = seen / (2 * std::tan(fov / 2));
        EXPECT_NEAR(contrast(cameraAt({0, 0, float(distance)}, {0, 0, -1}, fov, 0), 0), expected(texels), kTolerance)
            << texels;
        Camera behind = cameraAt({0, 0, float(distance)}, {0, 0, -1}, fov, 0); // rays start half way, as wide as there
        behind.near_plane = float(distance) / 2;
        EXPECT_NEAR(contrast(behind, 0), expected(texels), kTolerance) << texels << ", with a near plane";
    }
    // Aslant the pixel covers more of the wall.
    const double seen = 1.6 * kTexel * kSide, cosine = 0.5;
    const gpu::vec3 forward{0, float(-std::sqrt(1 - cosine * cosine)), float(-cosine)};
    EXPECT_NEAR(contrast(cameraAt(-3.0f * forward, forward, 0, seen), 0), expected(1.6 / std::sqrt(cosine)),
                kTolerance);
}

TEST_F(TextureLevel, GetsFinerAsFramesShareOutAPixel)
{
    addWall({-4, -4, 0}, {8, 0, 0}, {0, 8, 0});
    for (const uint32_t frame : {0u, 1u, 2u, 7u})
        EXPECT_NEAR(contrast(cameraAt({0, 0, 2}, {0, 0, -1}, 0, 4 * kTexel * kSide), frame),
                    expected(4.0 / (frame + 1)), kTolerance)
            << frame;
}

/// The ray widens along the whole chain.
TEST_F(TextureLevel, CountsTheWayToAMirrorAndFromIt)
{
    addWall({-4, -4, 5}, {0, 8, 0}, {8, 0, 0}); // faces away from +z
    builder_.quad({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, builder_.material(mirror(1, 1, 1)));
    const double texels = 2, fov = 0.4, way = texels * kTexel * kSide / (2 * std::tan(fov / 2));
    ASSERT_GT(way, 5.5);
    ASSERT_LT(way, 10); // the camera is between the mirror and the wall
    EXPECT_NEAR(contrast(cameraAt({0, 0, float(way - 5)}, {0, 0, -1}, fov, 0), 0), expected(texels), kTolerance);
}
} // namespace
