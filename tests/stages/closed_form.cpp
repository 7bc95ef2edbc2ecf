#include "tests/stages/closed_form.h"

#include <cmath>

namespace
{
constexpr std::array<const char*, 3> kChannels{"red", "green", "blue"};

const char* modeName(Mode mode)
{
    return mode == Mode::kReference ? "reference" : "direct";
}
} // namespace

Camera viewOf(gpu::vec3 point, gpu::vec3 towards_viewer, float distance, float size)
{
    const gpu::vec3 towards = normalize(towards_viewer);
    const gpu::vec3 aside = std::abs(towards.y) < 0.9f ? gpu::vec3{0, 1, 0} : gpu::vec3{1, 0, 0};
    return {.name = "",
            .position = point + distance * towards,
            .forward = -1.0f * towards,
            .up = normalize(cross(cross(towards, aside), towards)),
            .vertical_fov = 0,
            .orthographic_height = size};
}

Estimate estimate(const Picture& picture)
{
    const double n = double(picture.pixels.size());
    Rgb sum{}, squares{};
    for (const gpu::vec3& pixel : picture.pixels)
    {
        const std::array<float, 3> rgb{pixel.x, pixel.y, pixel.z};
        for (size_t c = 0; c < 3; ++c)
            sum[c] += rgb[c], squares[c] += double(rgb[c]) * rgb[c];
    }
    Estimate result;
    for (size_t c = 0; c < 3; ++c)
    {
        result.mean[c] = sum[c] / n;
        const double variance = std::max(0.0, squares[c] / n - result.mean[c] * result.mean[c]) * n / (n - 1);
        result.standard_error[c] = std::sqrt(variance / n);
    }
    return result;
}

Estimate ClosedForm::measure(const std::string& what, const SceneGpu& scene, const Camera& camera, Mode mode,
                             const Sampling& sampling)
{
    const Settings settings{.reference_depth = sampling.depth};
    const Picture picture = render(scene, camera, settings, sampling.sample_count, sampling.side, sampling.side, mode);
    const Estimate got = estimate(picture);
    for (size_t c = 0; c < 3; ++c)
        fmt::print("  {}, {}, {}: got {:.6g}, standard error {:.1e}\n", what, modeName(mode), kChannels[c], got.mean[c],
                   got.standard_error[c]);
    return got;
}

void ClosedForm::expect(const std::string& what, const SceneGpu& scene, const Camera& camera, Mode mode,
                        const Rgb& want, const Sampling& sampling)
{
    const Settings settings{.reference_depth = sampling.depth};
    const Picture picture = render(scene, camera, settings, sampling.sample_count, sampling.side, sampling.side, mode);
    const Estimate got = estimate(picture);
    for (size_t c = 0; c < 3; ++c)
    {
        const std::string where = fmt::format("{}, {}, {}", what, modeName(mode), kChannels[c]);
        if (want[c] == 0)
        {
            fmt::print("  {}: got {:.6g} want 0\n", where, got.mean[c]);
            EXPECT_EQ(got.mean[c], 0.0) << where;
            continue;
        }
        const double relative = got.mean[c] / want[c] - 1;
        const double standard_error = got.standard_error[c] / want[c];
        fmt::print("  {}: got {:.6g} want {:.6g} rel {:+.3f} % (standard error {:.3f} %)\n", where, got.mean[c],
                   want[c], 100 * relative, 100 * standard_error);
        EXPECT_LE(std::abs(relative), kTolerance) << where << ": got " << got.mean[c] << " want " << want[c];
        EXPECT_LT(standard_error, kLargestStandardError) << where << ": too few samples to tell";
    }
}

void ClosedForm::expectBoth(const std::string& what, const SceneGpu& scene, const Camera& camera, const Rgb& want,
                            const Sampling& sampling)
{
    expect(what, scene, camera, Mode::kReference, want, sampling);
    expect(what, scene, camera, Mode::kDirect, want, sampling);
}
