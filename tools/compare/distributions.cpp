#include "tools/compare/distributions.h"

#include "format/check.h"

#include <cmath>
#include <limits>

namespace
{

constexpr double kPrecision = 1e-15;
constexpr int kMostTerms = 100000; // about the square root of the parameters suffices
constexpr double kTiny = 1e-300;   // in place of a zero denominator (Lentz 1976)

double nonZero(double x)
{
    return std::abs(x) < kTiny ? kTiny : x;
}

/// b0 + a1 / (b1 + a2 / (b2 + ...)) by Lentz's method; `a(m)` and `b(m)` give the m-th terms.
template <typename A, typename B>
double continuedFraction(const A& a, const B& b)
{
    double value = nonZero(b(0)), numerator = value, denominator = 0;
    for (int m = 1; m < kMostTerms; ++m)
    {
        denominator = 1 / nonZero(b(m) + a(m) * denominator);
        numerator = nonZero(b(m) + a(m) / numerator);
        const double factor = numerator * denominator;
        value *= factor;
        if (std::abs(factor - 1) < kPrecision)
            break;
    }
    return value;
}

/// x^a (1 - x)^b / (a B(a, b)) over the continued fraction, which converges fast below the distribution's mean.
double betaBelowMean(double a, double b, double x)
{
    const double front =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x)) / a;
    const auto numerator = [&](int term)
    {
        const double m = term / 2;
        return term % 2 == 0 ? m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
                             : -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    };
    return front / continuedFraction(numerator, [](int) { return 1.0; });
}

double lowerGammaSeries(double a, double x)
{
    double term = 1 / a, sum = term;
    for (int m = 1; m < kMostTerms && term > kPrecision * sum; ++m)
        sum += term *= x / (a + m);
    return sum;
}

} // namespace

double regularisedBeta(double a, double b, double x)
{
    check(a > 0 && b > 0 && x >= 0 && x <= 1, "a {}, b {}, x {}", a, b, x);
    if (x == 0 || x == 1)
        return x;
    return x < (a + 1) / (a + b + 2) ? betaBelowMean(a, b, x) : 1 - betaBelowMean(b, a, 1 - x);
}

double regularisedGammaQ(double a, double x)
{
    check(a > 0 && x >= 0, "a {}, x {}", a, x);
    if (x == 0)
        return 1;
    if (std::isinf(x))
        return 0;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1)
        return 1 - front * lowerGammaSeries(a, x);
    const auto numerator = [&](int m) { return m * (a - m); };
    return front / continuedFraction(numerator, [&](int m) { return x + 1 - a + 2 * m; });
}

double studentP(double t, double degrees)
{
    check(degrees > 0, "{} degrees of freedom", degrees);
    if (std::isinf(t))
        return 0;
    return regularisedBeta(degrees / 2, 0.5, degrees / (degrees + t * t));
}

double chiSquaredP(double statistic, double degrees)
{
    return regularisedGammaQ(degrees / 2, statistic / 2);
}

double sidakThreshold(double alpha, uint64_t test_count)
{
    check(alpha > 0 && alpha < 1 && test_count > 0, "alpha {}, {} tests", alpha, test_count);
    return -std::expm1(std::log1p(-alpha) / double(test_count));
}
