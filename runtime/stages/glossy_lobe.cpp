#include "runtime/stages/glossy_lobe.h"

#include "format/check.h"
#include "format/parallel.h"

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

struct DiscPoint
{
    double x, y, rim; // rim: half the disc's chord along y there
};

constexpr int kDiscSteps = 32; // strata each way

/// Evenly over the unit disc.
const std::vector<DiscPoint>& discPoints()
{
    static const std::vector<DiscPoint> kPoints = []
    {
        std::vector<DiscPoint> points;
        for (int i = 0; i < kDiscSteps; ++i)
            for (int k = 0; k < kDiscSteps; ++k)
            {
                const double r = std::sqrt((i + 0.5) / kDiscSteps), phi = 2 * kPi * (k + 0.5) / kDiscSteps;
                const double x = r * std::cos(phi);
                points.push_back({x, r * std::sin(phi), std::sqrt(1 - x * x)});
            }
        return points;
    }();
    return kPoints;
}

/// By normals visible from the viewer (Heitz 2018): each then counts by the masking of its reflection alone.
Moments brdfMoments(double roughness, double cosine)
{
    const double alpha = roughness * roughness, sine = std::sqrt(1 - cosine * cosine);
    const double stretched = std::hypot(alpha * sine, cosine), vx = -alpha * sine / stretched, vz = cosine / stretched;
    Moments m;
    for (const auto& [a, across, rim] : discPoints())
    {
        const double s = 0.5 * (1 + vz), b = (1 - s) * rim + s * across;
        const double up = std::sqrt(std::max(0.0, 1 - a * a - b * b));
        // Across the plane of view is y; in it (vz, -vx) completes the frame of (vx, vz).
        const double nx = alpha * (b * vz + up * vx), ny = alpha * a, nz = std::max(1e-6, up * vz - b * vx);
        const double inverse = 1 / std::sqrt(nx * nx + ny * ny + nz * nz);
        const double hx = nx * inverse, hz = nz * inverse, facing = -sine * hx + cosine * hz;
        const double wx = 2 * facing * hx + sine, wz = 2 * facing * hz - cosine;
        if (wz <= 0)
            continue;
        const double masking =
            2 * wz / (wz + std::sqrt(alpha * alpha + (1 - alpha * alpha) * wz * wz)) / (kDiscSteps * kDiscSteps);
        const double away = std::max(0.0, 1 - facing), away2 = away * away;
        m.reflected += masking;
        m.rise += masking * away2 * away2 * away;
        m.x += masking * wx;
        m.z += masking * wz;
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
            const double r2 = (i + 0.5) / kSteps, z = std::sqrt(1 - r2),
                         x = std::sqrt(r2) * std::cos(2 * kPi * (k + 0.5) / kSteps);
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

/// A direction and concentration that a lobe may have.
struct Shape
{
    double x, z; // mean direction of the light that it takes
    float height, concentration;
};

/// All of the grid that take light enough from above.
std::vector<Shape> possibleShapes()
{
    std::vector<Shape> shapes;
    double upright = 0;
    for (int i = 0; i <= kTilts; ++i)
    {
        const double tilt = kPi / 2 * i / kTilts;
        const BandMoments bands = bandMoments(tilt);
        if (i == 0)
            upright = bands.whole[0];
        for (int k = 0; k <= kConcentrations; ++k)
        {
            const double a = kLeastConcentration + (kMostConcentration - kLeastConcentration) * k / kConcentrations;
            const std::array<double, 4> zonal{1, 3 * a, 5 * a * a * a, 7 * a * a * a * a * a * a};
            double whole = 0, x = 0, z = 0;
            for (size_t band = 0; band < 4; ++band)
            {
                whole += zonal[band] * bands.whole[band];
                x += zonal[band] * bands.x[band];
                z += zonal[band] * bands.z[band];
            }
            if (whole > 0.1 * upright)
                shapes.push_back({x / whole, z / whole, float(std::cos(tilt)), float(a)});
        }
    }
    return shapes;
}
} // namespace

gpu::GlossyLobe glossyLobe(double roughness, double cosine)
{
    static const std::vector<Shape> kShapes = possibleShapes();
    const Moments brdf = brdfMoments(roughness, std::clamp(cosine, kLeastCosine, 1.0));
    const auto distance = [&](const Shape& s)
    { return (s.x - brdf.x) * (s.x - brdf.x) + (s.z - brdf.z) * (s.z - brdf.z); };
    const Shape* nearest = &kShapes[0];
    double least = distance(*nearest);
    for (const Shape& shape : kShapes)
        if (const double d = distance(shape); d < least)
            least = d, nearest = &shape;
    return {.height = nearest->height,
            .concentration = nearest->concentration,
            .scale = float(brdf.reflected - brdf.rise),
            .bias = float(brdf.rise)};
}

std::vector<gpu::GlossyLobe> glossyLobes()
{
    std::vector<gpu::GlossyLobe> lobes(gpu::kLobeRoughnesses * gpu::kLobeCosines);
    std::vector<std::function<Status()>> rows;
    for (uint32_t r = 0; r < gpu::kLobeRoughnesses; ++r)
        rows.emplace_back(
            [&lobes, r]() -> Status
            {
                for (uint32_t c = 0; c < gpu::kLobeCosines; ++c)
                    lobes[r * gpu::kLobeCosines + c] = glossyLobe(
                        gpu::kHarmonicsFrom + (1 - gpu::kHarmonicsFrom) * r / double(gpu::kLobeRoughnesses - 1),
                        c / double(gpu::kLobeCosines - 1));
                return Success{};
            });
    check(bool(package::runAll(rows, true)), "integration cannot fail");
    return lobes;
}
