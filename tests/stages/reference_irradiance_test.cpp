// The path-traced irradiance of samples against formulas: indirect light all of it, direct light and caustics none.
#include "runtime/stages/reference_irradiance.h"
#include "tests/stages/closed_form.h"
#include "tests/stages/double3.h"

#include <cmath>

namespace
{
constexpr uint32_t kDepth = 64;

class ReferenceIrradianceTest : public ClosedForm
{
protected:
    /// `count` samples at one point.
    static std::vector<gpu::Sample> samplesAt(gpu::vec3 position, Double3 normal, uint32_t count)
    {
        return std::vector<gpu::Sample>(count, gpu::Sample{.position = position, .normal = packedNormal(normal)});
    }

    /// Expects the samples' mean to be `want` in every channel, to 4 standard errors, which are below 1 % of it.
    void expectIrradiance(const SceneGpu& scene, gpu::vec3 position, Double3 normal, double want)
    {
        constexpr uint32_t kSamples = 64, kRays = 256;
        const ReferenceIrradiance reference(device(), scene, kSamples, kRays);
        double sum = 0, variance = 0;
        for (const auto& estimate : reference.measure(samplesAt(position, normal, kSamples), kDepth, 5))
        {
            for (const double channel : estimate.irradiance)
                sum += channel;
            variance += estimate.standard_error * estimate.standard_error;
        }
        const double mean = sum / (3 * kSamples), error = std::sqrt(variance) / (3 * kSamples);
        printf("irradiance %.5f +- %.5f, want %.5f\n", mean, error, want);
        EXPECT_LE(error, 0.01 * want);
        EXPECT_NEAR(mean, want, 4 * error);
    }
};

/// Radiance is Le / (1 - albedo) everywhere, of which Le is emitted and the rest is what indirect light makes.
TEST_F(ReferenceIrradianceTest, FurnaceGivesWhatIsReflected)
{
    constexpr double kEmitted = 0.5, kAlbedo = 0.6;
    SceneBuilder builder;
    const nlohmann::json glowing = with(lambert(kAlbedo), {{"emissiveFactor", {kEmitted, kEmitted, kEmitted}}});
    builder.box({-1, -1, -1}, {1, 1, 1}, builder.material(glowing), true);
    const auto scene = load(builder.compile());
    expectIrradiance(*scene, {0.3f, -0.2f, 0.4f}, {0, 1, 0}, kPi * (kEmitted / (1 - kAlbedo) - kEmitted));
}

/// A square in the sun, seen from a point above its middle: E = albedo E_sun x form factor (Howell, B-3).
TEST_F(ReferenceIrradianceTest, SunlitSquareGivesItsFormFactor)
{
    constexpr double kAlbedo = 0.5, kSun = 3, kSide = 2, kHeight = 1.5;
    SceneBuilder builder;
    builder.floor(float(kSide), 0, builder.material(lambert(kAlbedo)));
    builder.light({{"type", "directional"}, {"intensity", kSun}},
                  {{"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}});
    const auto scene = load(builder.compile());
    const double a = kSide / 2 / kHeight, b = a / std::sqrt(1 + a * a);
    const double form_factor = 4 * (2 / (2 * kPi)) * b * std::atan(b);
    expectIrradiance(*scene, {0, float(kHeight), 0}, {0, -1, 0}, kAlbedo * kSun * form_factor);
}

/// A lamp straight ahead is direct light, and by way of a mirror a caustic.
TEST_F(ReferenceIrradianceTest, LampsAndTheirMirrorImagesGiveNothing)
{
    SceneBuilder builder;
    const nlohmann::json mirror = {{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}}};
    builder.floor(20, 0, builder.material(mirror));
    builder.quad({-2, 3, -2}, {4, 0, 0}, {0, 0, 4}, builder.material(emitter(5)));
    const auto scene = load(builder.compile());
    const ReferenceIrradiance reference(device(), *scene, 16, 64);
    for (const Double3 normal : {Double3{0, 1, 0}, Double3{0, -1, 0}})
        for (const auto& estimate : reference.measure(samplesAt({0, 1, 0}, normal, 16), kDepth, 1))
        {
            EXPECT_EQ(estimate.irradiance, grey(0));
            EXPECT_EQ(estimate.standard_error, 0);
        }
}
} // namespace
