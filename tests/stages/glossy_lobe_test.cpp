// The numbers that stand for the rough reflection lobe, against the lobe itself.
#include "shaders/lib/lobe_reflectance.h"
#include "tests/stages/double3.h"
#include "tests/stages/lobe_numbers.h"

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <numbers>

namespace
{
constexpr double kPi = std::numbers::pi;

/// The tolerance is the error of the fit that its header states.
TEST(LobeReflectance, IsTheDirectionalReflectance)
{
    double worst = 0, worst_grazing = 0;
    for (const double roughness : {0.03, 0.2, 0.5, 0.8, 1.0})
        for (const double cosine : {0.01, 0.05, 0.2, 0.5, 1.0})
        {
            const double got = kNormalReflectance * double(gpu::lobeScale(float(roughness), float(cosine))) +
                               double(gpu::lobeBias(float(roughness), float(cosine)));
            const double off = std::abs(got / specularAlbedo(roughness, cosine) - 1);
            (cosine < 0.05 ? worst_grazing : worst) = std::max(cosine < 0.05 ? worst_grazing : worst, off);
        }
    fmt::print("  largest error {:.3f}, below cosine 0.05 {:.3f}\n", worst, worst_grazing);
    EXPECT_LE(worst, 0.04);
    EXPECT_LE(worst_grazing, 0.09);
}

TEST(GlossyLobe, ReflectsAsMuchAsTheBrdf)
{
    double worst = 0;
    for (const double roughness : {0.4, 0.5, 0.6, 0.8, 1.0})
        for (const double cosine : {0.05, 0.2, 0.5, 0.8, 1.0})
        {
            const double want = specularAlbedo(roughness, cosine);
            worst = std::max(worst, std::abs(reflectanceOf(glossyLobe(roughness, cosine)) / want - 1));
        }
    fmt::print("  largest error of the quadrature {:.2e}\n", worst);
    EXPECT_LE(worst, 0.01); // 32 strata each way, some cut by the horizon
}

/// Mean direction of the light that a lobe takes from even light, by the judge's BRDF: a metal that reflects all there
/// is. Allowed: what a grid of 1/64 of a right angle and 1/96 of the concentration leaves, and as much where no such
/// lobe leans as far towards the horizon as the BRDF does.
TEST(GlossyLobe, TakesLightFromWhereTheBrdfDoes)
{
    constexpr int kSteps = 256;
    for (const double roughness : {0.4, 0.5, 0.6, 0.8, 1.0})
        for (const double cosine : {0.3, 0.6, 0.9, 1.0})
        {
            const GltfMaterial material{.base_color = {1, 1, 1}, .metallic = 1, .roughness = roughness};
            const gpu::GlossyLobe lobe = glossyLobe(roughness, cosine);
            const auto zonal = zonalOf(lobe);
            const Double3 d{std::sqrt(1 - double(lobe.height) * lobe.height), 0, lobe.height};
            Double3 want, got;
            double all_wanted = 0, all = 0, negative = 0;
            for (int i = 0; i < kSteps; ++i)
                for (int k = 0; k < kSteps; ++k)
                {
                    const double theta = kPi / 2 * (i + 0.5) / kSteps, phi = 2 * kPi * (k + 0.5) / kSteps;
                    const Double3 w{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
                    const double brdf =
                        gltfBrdf(material, {-std::sqrt(1 - cosine * cosine), 0, cosine}, {w.x, w.y, w.z})[0];
                    const double x = dot(w, d), solid_angle = w.z * std::sin(theta);
                    const double f =
                        1 + zonal[1] * x + zonal[2] * (1.5 * x * x - 0.5) + zonal[3] * (2.5 * x * x * x - 1.5 * x);
                    want = want + brdf * solid_angle * w;
                    got = got + f * solid_angle * w;
                    all_wanted += brdf * solid_angle;
                    all += f * solid_angle;
                    negative -= std::min(0.0, f) * solid_angle;
                }
            fmt::print("  roughness {:.2f}, cosine {:.1f}: off by {:.3f}, {:.1f} % negative\n", roughness, cosine,
                       length((1 / all) * got - (1 / all_wanted) * want), 100 * negative / all);
            EXPECT_LE(length((1 / all) * got - (1 / all_wanted) * want), 2 * (kPi / 2 / 64 + 1.0 / 96))
                << roughness << ' ' << cosine;
        }
}
} // namespace
