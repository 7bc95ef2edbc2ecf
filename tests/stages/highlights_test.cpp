// Highlights of lamps while the camera moves: what is remembered of direct light follows them.
#include "runtime/renderer.h"
#include "tests/stages/gpu_test.h"
#include "tests/stages/scene_builder.h"

#include <cmath>

namespace
{
constexpr uint32_t kWidth = 96, kHeight = 64;

float brightness(const gpu::vec3& c)
{
    return (c.x + c.y + c.z) / 3;
}

class Highlights : public GpuTest
{
protected:
    /// Dark plastic below two lamps. Where nothing hides them, direct light is exact in every frame.
    static void addFloor(SceneBuilder& builder, double roughness)
    {
        const nlohmann::json surface{
            {"baseColorFactor", {0.05, 0.05, 0.05, 1}}, {"metallicFactor", 0}, {"roughnessFactor", roughness}};
        builder.floor(20, 0, builder.material({{"pbrMetallicRoughness", surface}}));
        for (const double x : {-1.0, 1.5})
            builder.light({{"type", "point"}, {"intensity", 100}}, {{"translation", {x, 1.5, -2}}});
    }

    /// Of the last of `frames` frames, in which the camera moves past at 5 cm a frame and ends at the same place.
    std::vector<gpu::vec3> picture(const SceneGpu& scene, Mode mode, int frames, uint32_t standing = 0)
    {
        Settings settings;
        settings.term = gpu::kTermDirect;
        Renderer renderer(device(), scene, mode, kWidth, kHeight, settings);
        Recorder rec(device());
        for (int frame = 1 - frames; frame <= int(standing); ++frame)
        {
            Camera camera;
            camera.position = {0.05f * float(std::min(frame, 0)), 1, 3};
            rec.begin(scene.descriptorSet());
            renderer.record(rec, camera, settings, 7);
            rec.submitAndWait();
        }
        return renderer.picture(device());
    }
};

/// Brightness of the pixels that are brighter than the mean, over what it should be.
double highlightRatio(const std::vector<gpu::vec3>& got, const std::vector<gpu::vec3>& truth)
{
    double mean = 0;
    for (const gpu::vec3& pixel : truth)
        mean += double(brightness(pixel)) / double(truth.size());
    double bright = 0, of = 0;
    for (size_t i = 0; i < truth.size(); ++i)
        if (brightness(truth[i]) > mean)
        {
            bright += double(brightness(got[i]));
            of += double(brightness(truth[i]));
        }
    return bright / of;
}

double rootMeanSquare(const std::vector<gpu::vec3>& got, const std::vector<gpu::vec3>& truth)
{
    double squares = 0, of = 0;
    for (size_t i = 0; i < truth.size(); ++i)
    {
        squares += std::pow(double(brightness(got[i]) - brightness(truth[i])), 2);
        of += std::pow(double(brightness(truth[i])), 2);
    }
    return std::sqrt(squares / of);
}
} // namespace

TEST_F(Highlights, AreWhereTheEyeSeesThemNow)
{
    for (const double roughness : {0.3, 0.5})
    {
        SceneBuilder builder;
        addFloor(builder, roughness);
        const auto scene = load(builder.compile());
        const auto truth = picture(*scene, Mode::kDirect, 1, 31);
        const auto moved = picture(*scene, Mode::kGi, 16);
        const double ratio = highlightRatio(moved, truth), error = rootMeanSquare(moved, truth);
        fmt::print("  roughness {}: highlights {:.4f} of the truth, error {:.4f}\n", roughness, ratio, error);
        EXPECT_NEAR(ratio, 1, 0.02);
        EXPECT_LT(error, 0.1) << "0.8 and 0.4 where histories stick to the floor";
    }
}

TEST_F(Highlights, OfALampLeaveNoGhostsInItsShadow)
{
    SceneBuilder builder;
    addFloor(builder, 0.3);
    builder.box({-1.2f, 0, -1.6f}, {-0.2f, 1.2f, -1.5f}, builder.material(lambert(0.05)));
    const auto scene = load(builder.compile());
    const auto truth = picture(*scene, Mode::kDirect, 1, 127);
    const auto moved = picture(*scene, Mode::kGi, 16);
    const double ratio = highlightRatio(moved, truth), error = rootMeanSquare(moved, truth);
    fmt::print("  highlights {:.4f} of the truth, error {:.4f}\n", ratio, error);
    EXPECT_NEAR(ratio, 1, 0.05);
    EXPECT_LT(error, 0.15) << "0.09 where histories keep their length";
}
