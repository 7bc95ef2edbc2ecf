#include "runtime/stages/glossy_lobe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace
{
constexpr double kLeastCosine = 0.01; // of the viewer; the lobe has no limit at 0

struct Vector
{
    double x, y, z;
};

struct Sample
{
    Vector w;       // local, the viewer in the plane y = 0, x < 0
    double brdf;    // GGX without Fresnel, 1/sr
    double fresnel; // (1 - w.h)^5, h halfway between w and the viewer
    double solid_angle;
};

/// Midpoints over the half y > 0 of the hemisphere, which stands for both.
template <typename Visit>
void forDirections(double roughness, double cosine, Visit&& visit)
{
    constexpr int kSteps = 32;
    const double alpha2 = std::pow(roughness, 4), sine = std::sqrt(1 - cosine * cosine);
    const auto masking = [&](double c) { return 2 * c / (c + std::sqrt(alpha2 + (1 - alpha2) * c * c)); };
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k)
        {
            const double theta = std::numbers::pi / 2 * (i + 0.5) / kSteps, phi = std::numbers::pi * (k + 0.5) / kSteps;
            const Vector w{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
            const double length = std::sqrt(2 + 2 * (cosine * w.z - sine * w.x)), hz = (w.z + cosine) / length;
            const double d = hz * hz * (alpha2 - 1) + 1;
            const double brdf = alpha2 / (std::numbers::pi * d * d) * masking(cosine) * masking(w.z) / (4 * cosine * w.z);
            const double away = std::max(0.0, 1 - length / 2); // |viewer + w| = 2 w.h
            visit(Sample{.w = w,
                         .brdf = brdf,
                         .fresnel = away * away * away * away * away,
                         .solid_angle = 2 * std::sin(theta) * (std::numbers::pi / 2 / kSteps) * (std::numbers::pi / kSteps)});
        }
}

} // namespace

gpu::GlossyLobe glossyLobe(double roughness, double cosine)
{
    cosine = std::clamp(cosine, kLeastCosine, 1.0);
    Vector mean{};
    double scale = 0, bias = 0;
    forDirections(roughness, cosine,
                  [&](const Sample& s)
                  {
                      const double weight = s.brdf * s.solid_angle;
                      mean.x += weight * s.w.x;
                      mean.z += weight * s.w.z;
                      scale += weight * s.w.z * (1 - s.fresnel);
                      bias += weight * s.w.z * s.fresnel;
                  });
    const double length = std::hypot(mean.x, mean.z);
    const Vector d{mean.x / length, 0, mean.z / length};
    std::array<double, 4> moments{}; // of the Legendre polynomials about d
    forDirections(roughness, cosine,
                  [&](const Sample& s)
                  {
                      const double weight = s.brdf * s.solid_angle, x = s.w.x * d.x + s.w.z * d.z;
                      moments[0] += weight;
                      moments[1] += weight * x;
                      moments[2] += weight * (1.5 * x * x - 0.5);
                      moments[3] += weight * (2.5 * x * x * x - 1.5 * x);
                  });
    const auto zonal = [&](size_t band) { return float(double(2 * band + 1) * moments[band] / moments[0]); };
    return {.zonal = {zonal(1), zonal(2), zonal(3)}, .height = float(d.z), .scale = float(scale), .bias = float(bias)};
}

std::vector<gpu::GlossyLobe> glossyLobes()
{
    std::vector<gpu::GlossyLobe> lobes;
    for (uint32_t r = 0; r < gpu::kLobeRoughnesses; ++r)
        for (uint32_t c = 0; c < gpu::kLobeCosines; ++c)
            lobes.push_back(glossyLobe(gpu::kHarmonicsFrom + (1 - gpu::kHarmonicsFrom) * r / double(gpu::kLobeRoughnesses - 1),
                                       c / double(gpu::kLobeCosines - 1)));
    return lobes;
}
