#include "runtime/stages/glossy_lobe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace
{
constexpr double kPi = std::numbers::pi;
constexpr double kLeastCosine = 0.01; // of the viewer; the lobe has no limit at 0
constexpr int kTilts = 64, kConcentrations = 96;
constexpr double kLeastConcentration = -0.2, kMostConcentration = 0.95;

/// Sums over the lobe, which is normalized by `reflected`.
struct Moments
{
    double reflected = 0, rise = 0; // Int f cos dw without Fresnel, and weighted by Schlick's (1 - w.h)^5
    double x = 0, z = 0;            // mean direction; the viewer is at x < 0
};

/// By normals visible from the viewer (Heitz 2018): each then counts by the masking of its reflection alone.
Moments brdfMoments(double roughness, double cosine)
{
    constexpr int kSteps = 32; // strata each way
    const double alpha = roughness * roughness, sine = std::sqrt(1 - cosine * cosine);
    const double stretched = std::hypot(alpha * sine, cosine), vx = -alpha * sine / stretched, vz = cosine / stretched;
    Moments m;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k)
        {
            const double r = std::sqrt((i + 0.5) / kSteps), phi = 2 * kPi * (k + 0.5) / kSteps, a = r * std::cos(phi);
            const double s = 0.5 * (1 + vz), b = (1 - s) * std::sqrt(1 - a * a) + s * r * std::sin(phi);
            const double up = std::sqrt(std::max(0.0, 1 - a * a - b * b));
            // Across the plane of view is y; in it (vz, -vx) completes the frame of (vx, vz).
            const double nx = alpha * (b * vz + up * vx), ny = alpha * a, nz = std::max(1e-6, up * vz - b * vx);
            const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
            const double hx = nx / length, hz = nz / length, facing = -sine * hx + cosine * hz;
            const double wx = 2 * facing * hx + sine, wz = 2 * facing * hz - cosine;
            if (wz <= 0)
                continue;
            const double masking = 2 * wz / (wz + std::sqrt(alpha * alpha + (1 - alpha * alpha) * wz * wz));
            const double away = std::max(0.0, 1 - facing);
            m.reflected += masking / (kSteps * kSteps);
            m.rise += masking * away * away * away * away * away / (kSteps * kSteps);
            m.x += masking * wx / (kSteps * kSteps);
            m.z += masking * wz / (kSteps * kSteps);
        }
    m.x /= m.reflected;
    m.z /= m.reflected;
    return m;
}

/// Int cos P_l(w.d) {1, w.x, w.z} dw over the hemisphere, bands 0 to 3.
struct BandMoments
{
    std::array<double, 4> whole{}, x{}, z{};
};

BandMoments bandMoments(double tilt)
{
    constexpr int kSteps = 24; // the integrands are polynomials of low order
    BandMoments m;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k)
        {
            const double r2 = (i + 0.5) / kSteps, z = std::sqrt(1 - r2), x = std::sqrt(r2) * std::cos(2 * kPi * (k + 0.5) / kSteps);
            const double t = x * std::sin(tilt) + z * std::cos(tilt);
            const std::array<double, 4> p{1, t, 1.5 * t * t - 0.5, 2.5 * t * t * t - 1.5 * t};
            for (size_t band = 0; band < 4; ++band)
            {
                m.whole[band] += p[band];
                m.x[band] += p[band] * x;
                m.z[band] += p[band] * z;
            }
        }
    return m;
}
} // namespace

gpu::GlossyLobe glossyLobe(double roughness, double cosine)
{
    static const std::array<BandMoments, kTilts + 1> kBands = []
    {
        std::array<BandMoments, kTilts + 1> bands;
        for (int i = 0; i <= kTilts; ++i)
            bands[size_t(i)] = bandMoments(kPi / 2 * i / kTilts);
        return bands;
    }();
    const Moments brdf = brdfMoments(roughness, std::clamp(cosine, kLeastCosine, 1.0));
    gpu::GlossyLobe lobe{.height = 1, .concentration = 0, .scale = float(brdf.reflected - brdf.rise), .bias = float(brdf.rise)};
    double least = 1e30;
    for (int i = 0; i <= kTilts; ++i)
        for (int k = 0; k <= kConcentrations; ++k)
        {
            const double a = kLeastConcentration + (kMostConcentration - kLeastConcentration) * k / kConcentrations;
            const std::array<double, 4> zonal{1, 3 * a, 5 * a * a * a, 7 * a * a * a * a * a * a};
            double whole = 0, x = 0, z = 0;
            for (size_t band = 0; band < 4; ++band)
            {
                whole += zonal[band] * kBands[size_t(i)].whole[band];
                x += zonal[band] * kBands[size_t(i)].x[band];
                z += zonal[band] * kBands[size_t(i)].z[band];
            }
            const double dx = x / whole - brdf.x, dz = z / whole - brdf.z, difference = dx * dx + dz * dz;
            if (whole > 0.1 * kBands[0].whole[0] && difference < least)
            {
                least = difference;
                lobe.height = float(std::cos(kPi / 2 * i / kTilts));
                lobe.concentration = float(a);
            }
        }
    return lobe;
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
