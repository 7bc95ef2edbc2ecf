#include "tools/compare/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace
{

constexpr double kPi = std::numbers::pi;

struct Gaussian // a * sqrt(pi / b) * exp(-pi^2 x^2 / b), x in degrees (Table 1 of the LDR paper)
{
    double a, b;
};
constexpr Gaussian kAchromatic{1.0, 0.0047};
constexpr Gaussian kRedGreen{1.0, 0.0053};
constexpr Gaussian kBlueYellow[2] = {{34.1, 0.04}, {13.5, 0.025}};

/// exp(-pi^2 x^2 / b) on the pixel grid, scaled by `weight`.
std::vector<double> bell(double b, double weight, int radius, double pixels_per_degree)
{
    std::vector<double> values;
    for (int i = -radius; i <= radius; ++i)
    {
        const double x = i / pixels_per_degree;
        values.push_back(weight * std::exp(-kPi * kPi * x * x / b));
    }
    return values;
}

double sum(const std::vector<double>& values)
{
    double total = 0;
    for (double value : values)
        total += value;
    return total;
}

/// Divides by `norm` and drops outer taps too small to change a float result.
Taps trimmed(const std::vector<double>& values, double norm)
{
    constexpr double kNegligible = 1e-9;
    size_t first = 0;
    while (first < values.size() / 2 && std::abs(values[first] / norm) < kNegligible)
        ++first;
    Taps taps;
    for (size_t i = first; i < values.size() - first; ++i)
        taps.weights.push_back(float(values[i] / norm));
    return taps;
}

/// Scales the positive values to sum to 1 and the negative ones to -1.
Taps balanced(const std::vector<double>& values)
{
    double positive = 0, negative = 0;
    for (double value : values)
        (value > 0 ? positive : negative) += std::abs(value);
    Taps taps;
    for (double value : values)
        taps.weights.push_back(float(value > 0 ? value / positive : negative > 0 ? value / negative : 0.0));
    return taps;
}

} // namespace

ContrastFilters contrastFilters(float pixels_per_degree)
{
    // One radius for all, from the widest Gaussian: three standard deviations.
    const double widest = std::max({kAchromatic.b, kRedGreen.b, kBlueYellow[0].b, kBlueYellow[1].b});
    const int radius = int(std::ceil(3.0 * std::sqrt(widest / (2.0 * kPi * kPi)) * double(pixels_per_degree)));

    const auto single = [&](const Gaussian& gaussian)
    {
        const std::vector<double> values = bell(gaussian.b, 1.0, radius, pixels_per_degree);
        return trimmed(values, sum(values));
    };
    ContrastFilters filters{single(kAchromatic), single(kRedGreen), {}};

    // Each half carries the square root of its two-dimensional weight, and the two-dimensional sum is 1.
    std::vector<double> halves[2];
    double total = 0;
    for (int i = 0; i < 2; ++i)
    {
        const Gaussian& gaussian = kBlueYellow[i];
        halves[i] = bell(gaussian.b, std::sqrt(gaussian.a * std::sqrt(kPi / gaussian.b)), radius, pixels_per_degree);
        total += sum(halves[i]) * sum(halves[i]);
    }
    for (int i = 0; i < 2; ++i)
        filters.blue_yellow[i] = trimmed(halves[i], std::sqrt(total));
    return filters;
}

FeatureFilters featureFilters(float pixels_per_degree)
{
    constexpr double kFeatureWidth = 0.082; // degrees
    const double deviation = 0.5 * kFeatureWidth * double(pixels_per_degree);
    const int radius = int(std::ceil(3.0 * deviation));
    std::vector<double> smooth, edge, point;
    for (int x = -radius; x <= radius; ++x)
    {
        const double g = std::exp(-double(x) * x / (2.0 * deviation * deviation));
        smooth.push_back(g);
        edge.push_back(-x * g);
        point.push_back((double(x) * x / (deviation * deviation) - 1.0) * g);
    }
    return {trimmed(smooth, sum(smooth)), balanced(edge), balanced(point)};
}
