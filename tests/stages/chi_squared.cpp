#include "tests/stages/chi_squared.h"

#include "format/check.h"
#include "tools/compare/distributions.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

namespace
{
constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kLeastExpected = 5; // below it Pearson's statistic is not chi-squared distributed
constexpr double kAlpha = 0.01;
} // namespace

ChiSquared chiSquared(const std::vector<double>& counts, const std::vector<double>& expected)
{
    check(counts.size() == expected.size(), "{} and {} cells", counts.size(), expected.size());
    std::vector<size_t> by_expected(expected.size());
    std::iota(by_expected.begin(), by_expected.end(), size_t(0));
    std::ranges::sort(by_expected, {}, [&](size_t i) { return expected[i]; });
    ChiSquared result;
    uint32_t cells = 0;
    double pooled = 0, pooled_expected = 0;
    for (const size_t i : by_expected) // small ones first: they fill up a cell
    {
        pooled += counts[i];
        pooled_expected += expected[i];
        if (pooled_expected < kLeastExpected)
            continue;
        result.statistic += (pooled - pooled_expected) * (pooled - pooled_expected) / pooled_expected;
        ++cells;
        pooled = pooled_expected = 0;
    }
    check(cells >= 2, "{} cells with enough samples", cells);
    result.degrees = cells - 1;
    result.p = chiSquaredP(result.statistic, result.degrees);
    return result;
}

void ChiSquaredTests::add(const std::string& what, const ChiSquared& test)
{
    tests_.push_back({what, test});
}

void ChiSquaredTests::expectAll() const
{
    const double threshold = sidakThreshold(kAlpha, tests_.size());
    for (const auto& [what, test] : tests_)
    {
        fmt::print("  {}: chi-squared {:.1f} with {} degrees of freedom, p {:.3g}\n", what, test.statistic,
                   test.degrees, test.p);
        EXPECT_GE(test.p, threshold) << what;
    }
}

SphereGrid::SphereGrid(Double3 axis, double width) : axis_(axis), width_(width)
{
    const Double3 other = std::abs(axis.z) < 0.9 ? Double3(0, 0, 1) : Double3(1, 0, 0);
    up_ = normalized(other - dot(other, axis) * axis);
    side_ = Double3(up_.y * axis.z - up_.z * axis.y, up_.z * axis.x - up_.x * axis.z, up_.x * axis.y - up_.y * axis.x);
}

// Rings are equal steps of s = m / (m + width) * (2 + width) / 2 with m = 1 - cos, from 0 to 1.

uint32_t SphereGrid::cellOf(Double3 direction) const
{
    const double m = length2(direction - axis_) / 2; // of unit vectors; exact where 1 - cos cancels
    const double s = m / (m + width_) * (2 + width_) / 2;
    const double slice = std::atan2(dot(direction, up_), dot(direction, side_)) / kTwoPi + 0.5;
    return std::min(uint32_t(s * kRings), kRings - 1) * kSlices + std::min(uint32_t(slice * kSlices), kSlices - 1);
}

double SphereGrid::simpson(const std::function<double(Double3)>& density, const Patch& patch, uint32_t steps) const
{
    const auto weight = [&](uint32_t i) { return i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0; };
    double sum = 0;
    for (uint32_t i = 0; i <= steps; ++i)
    {
        const double s = (patch.s0 + (patch.s1 - patch.s0) * i / steps) * 2 / (2 + width_), m = s * width_ / (1 - s);
        const double solid_angle = width_ / ((1 - s) * (1 - s)) * 2 / (2 + width_) * weight(i);
        const double sine = std::sqrt(std::max(0.0, m * (2 - m)));
        for (uint32_t k = 0; k <= steps; ++k)
        {
            const double phi = patch.phi0 + (patch.phi1 - patch.phi0) * k / steps;
            sum += solid_angle * weight(k) *
                   density((1 - m) * axis_ + sine * (std::cos(phi) * side_ + std::sin(phi) * up_));
        }
    }
    return sum * (patch.s1 - patch.s0) * (patch.phi1 - patch.phi0) / (9 * steps * steps);
}

double SphereGrid::integral(const std::function<double(Double3)>& density, const Patch& patch, double tolerance,
                            uint32_t depth) const
{
    // Points on the rim, too, so that no jump hides there; two rules may agree by accident where the density jumps,
    // hardly three.
    const double fine = simpson(density, patch, 6);
    if (depth == 0)
        return fine;
    if (std::abs(fine - simpson(density, patch, 4)) <= tolerance)
        if (const double finest = simpson(density, patch, 8); std::abs(finest - fine) <= tolerance)
            return finest;
    const double s = (patch.s0 + patch.s1) / 2, phi = (patch.phi0 + patch.phi1) / 2;
    double sum = 0;
    for (const Patch& part : {Patch{patch.s0, s, patch.phi0, phi}, Patch{patch.s0, s, phi, patch.phi1},
                              Patch{s, patch.s1, patch.phi0, phi}, Patch{s, patch.s1, phi, patch.phi1}})
        sum += integral(density, part, tolerance / 2, depth - 1); // errors of either sign
    return sum;
}

std::vector<double> SphereGrid::integrate(const std::function<double(Double3)>& density) const
{
    // A fifth of a sample in 200000, against a deviation of 2 or more in cells that count. A lobe that is narrower than
    // the points lie apart could be overlooked: hence patches that are smaller than cells from the start.
    constexpr double kTolerance = 1e-6;
    constexpr uint32_t kDepth = 8, kParts = 2;
    std::vector<double> result(cellCount());
    double sum = 0;
    for (uint32_t i = 0; i < kRings * kParts; ++i)
        for (uint32_t k = 0; k < kSlices * kParts; ++k)
        {
            const auto at = [](uint32_t part, uint32_t count) { return double(part) / (count * kParts); };
            const Patch patch{at(i, kRings), at(i + 1, kRings), (at(k, kSlices) - 0.5) * kTwoPi,
                              (at(k + 1, kSlices) - 0.5) * kTwoPi};
            const double probability = integral(density, patch, kTolerance / kParts, kDepth);
            result[i / kParts * kSlices + k / kParts] += probability;
            sum += probability;
        }
    result[absorbedCell()] = 1 - sum;
    return result;
}
