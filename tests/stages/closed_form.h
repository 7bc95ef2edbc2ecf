// Measures a rendered picture against a radiance known from a formula.
#pragma once
#include "tests/stages/gpu_test.h"
#include "tests/stages/scene_builder.h"

#include <array>
#include <numbers>

using Rgb = std::array<double, 3>;
inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180;

constexpr Rgb grey(double value)
{
    return {value, value, value};
}

/// Parallel rays onto a square of `size` metres about `point`, which the viewer sees from `towards_viewer`,
/// `distance` metres away.
Camera viewOf(gpu::vec3 point, gpu::vec3 towards_viewer, float distance = 1, float size = 1e-4f);

/// Mean and standard error of the mean over a picture whose pixels are independent estimates of one value.
struct Estimate
{
    Rgb mean{};
    Rgb standard_error{};
};
Estimate estimate(const Picture& picture);

class ClosedForm : public GpuTest
{
protected:
    struct Sampling
    {
        uint32_t side = 8;         // pixels of the square picture
        uint32_t sample_count = 4; // a pixel
        uint32_t depth = 4;        // vertices of a path of the reference
    };

    /// Renders what `camera` sees, every pixel showing one value, and expects it to be `want`: to 0.5 % where `want` is
    /// not 0, with a standard error below 0.1 %, and exactly where it is 0. Prints both.
    void expect(const std::string& what, const SceneGpu& scene, const Camera& camera, Mode mode, const Rgb& want,
                const Sampling& sampling);
    /// The same in both modes.
    void expectBoth(const std::string& what, const SceneGpu& scene, const Camera& camera, const Rgb& want,
                    const Sampling& sampling);
    Estimate measure(const std::string& what, const SceneGpu& scene, const Camera& camera, Mode mode,
                     const Sampling& sampling);

    static constexpr double kTolerance = 0.005;
    static constexpr double kLargestStandardError = 0.001; // of what is wanted
};
