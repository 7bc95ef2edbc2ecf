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

    /// What the camera sees of the scene.
    std::vector<gpu::DiffusePoint> seen(const Camera& camera, uint32_t frame)
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
        return contents<gpu::DiffusePoint>(out->diffuse_points, kSide * kSide);
    }

    /// Lightest minus darkest of what is seen of the stripes, as a fraction of white.
    double contrast(const Camera& camera, uint32_t frame)
    {
        float least = 1, most = 0;
        for (const gpu::DiffusePoint& p : seen(camera, frame))
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
}

/// Aslant a pixel covers more of the wall, but only along the stripes.
TEST_F(TextureLevel, IsNoCoarserAcrossWhatAPixelCoversAslant)
{
    addWall({-4, -4, 0}, {8, 0, 0}, {0, 8, 0});
    const double seen = 1.6 * kTexel * kSide;
    for (const double cosine : {1 / 2.0, 1 / 3.0})
    {
        const gpu::vec3 forward{0, float(-std::sqrt(1 - cosine * cosine)), float(-cosine)};
        EXPECT_NEAR(contrast(cameraAt(-6.0f * forward, forward, 0, seen), 0), expected(1.6), kTolerance) << cosine;
    }
}

/// Waves along the wall, seen at 7 degrees: every pixel shows their mean over what it covers.
TEST_F(TextureLevel, IsTheMeanOverWhatAPixelCoversAslant)
{
    constexpr double kPeriod = 32, kCosine = 1.0 / 8, kPixel = 2; // texels, and texels across a pixel
    std::vector<uint8_t> waves;
    for (uint32_t y = 0; y < kTexels; ++y)
        for (uint32_t x = 0; x < kTexels; ++x)
        {
            const double linear = 0.5 + 0.5 * std::sin(2 * std::numbers::pi * (y + 0.5) / kPeriod);
            const double coded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
            const auto texel = uint8_t(std::lround(255 * coded));
            waves.insert(waves.end(), {texel, texel, texel, 255});
        }
    constexpr double kRepeats = 10;
    const nlohmann::json texture{{"index", builder_.texture(uint32_t(kTexels), uint32_t(kTexels), waves)},
                                 {"extensions", {{"KHR_texture_transform", {{"scale", {kRepeats, kRepeats}}}}}}};
    const float side = float(kRepeats * kWallSide);
    builder_.quad({-side / 2, -side / 2, 0}, {side, 0, 0}, {0, side, 0},
                  builder_.material(with(lambert(1), {{"pbrMetallicRoughness", {{"baseColorTexture", texture}}}})));
    const gpu::vec3 forward{0, float(-std::sqrt(1 - kCosine * kCosine)), float(-kCosine)};
    const auto points = seen(cameraAt(-20.0f * forward, forward, 0, kPixel * kTexel * kSide), 0);

    const double covered = PrimaryStage::kTextureBlur * kPixel / kCosine, turn = std::numbers::pi * covered / kPeriod;
    // What a linear filter between texels of the coarser of two levels adds to the mean: an eighth of the square of their
    // distance, times the second derivative. Texels are stored in steps of 1/255 of a curve of slope 2.4 at most, in both levels.
    const double texel = std::exp2(std::ceil(std::log2(PrimaryStage::kTextureBlur * kPixel)));
    const double curvature = 0.5 * std::pow(2 * std::numbers::pi / kPeriod, 2);
    const double tolerance = texel * texel / 8 * curvature + 2 * 2.4 * 0.5 / 255;
    double least = 1, most = 0;
    for (const gpu::DiffusePoint& p : points)
    {
        const double place = (p.position.y + side / 2) / kTexel; // texels
        const double sine = std::sin(2 * std::numbers::pi * place / kPeriod);
        const double mean = 0.5 + 0.5 * std::sin(turn) / turn * sine;
        EXPECT_NEAR(p.reflectance.x, mean, tolerance) << place;
        least = std::min(least, mean), most = std::max(most, mean);
    }
    EXPECT_GT(most - least, 0.75); // whole waves are seen
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
