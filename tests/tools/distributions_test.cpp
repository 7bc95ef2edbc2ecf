// Tail probabilities against closed forms, printed tables and plain sums.
#include "tools/compare/distributions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace
{

constexpr double kPi = std::numbers::pi;

void expectClose(double got, double want, double relative = 1e-12)
{
    EXPECT_NEAR(got, want, relative * want);
}

TEST(Distributions, IncompleteBetaHasItsClosedForms)
{
    EXPECT_EQ(regularisedBeta(2, 3, 0), 0);
    EXPECT_EQ(regularisedBeta(2, 3, 1), 1);
    expectClose(regularisedBeta(2, 3, 0.5), 0.6875);
    for (const double x : {1e-9, 0.01, 0.3, 0.5, 0.77, 0.999})
    {
        expectClose(regularisedBeta(0.5, 0.5, x), 2 / kPi * std::asin(std::sqrt(x)));
        for (const double a : {0.3, 1.0, 2.5, 40.0})
        {
            expectClose(regularisedBeta(a, 1, x), std::pow(x, a));
            EXPECT_NEAR(regularisedBeta(1, a, x), 1 - std::pow(1 - x, a), 1e-12);
            EXPECT_NEAR(regularisedBeta(a, 7.5, x) + regularisedBeta(7.5, a, 1 - x), 1,
                        1e-12 + 1e-16 / x); // 1 - x is rounded
        }
    }
}

TEST(Distributions, IncompleteBetaIsABinomialTail)
{
    // P(at least k of n) = I_x(k, n - k + 1)
    for (const int n : {1, 20, 400})
        for (const int k : {1, n / 3 + 1, n})
            for (const double x : {0.05, 0.4, 0.9})
            {
                double sum = 0;
                for (int i = k; i <= n; ++i)
                    sum += std::exp(std::lgamma(n + 1) - std::lgamma(i + 1) - std::lgamma(n - i + 1) + i * std::log(x) +
                                    (n - i) * std::log1p(-x));
                EXPECT_NEAR(regularisedBeta(k, n - k + 1, x), sum, 1e-10) << n << ", " << k << ", " << x;
            }
}

TEST(Distributions, IncompleteGammaHasItsClosedForms)
{
    EXPECT_EQ(regularisedGammaQ(3, 0), 1);
    EXPECT_EQ(regularisedGammaQ(3, std::numeric_limits<double>::infinity()), 0);
    for (const double x : {1e-6, 0.2, 1.0, 2.4, 9.0, 100.0})
    {
        expectClose(regularisedGammaQ(1, x), std::exp(-x));
        expectClose(regularisedGammaQ(0.5, x), std::erfc(std::sqrt(x)), 1e-11);
    }
    for (const int a : {2, 30, 1000}) // a Poisson sum
        for (const double x : {0.5 * a, 0.97 * a, 1.0 * a, 1.1 * a})
        {
            double sum = 0;
            for (int k = 0; k < a; ++k)
                sum += std::exp(k * std::log(x) - x - std::lgamma(k + 1));
            EXPECT_NEAR(regularisedGammaQ(a, x), sum, 1e-10) << a << ", " << x;
        }
}

TEST(Distributions, StudentsTailIsThatOfTheTables)
{
    EXPECT_NEAR(studentP(12.7062047, 1), 0.05, 1e-8);
    EXPECT_NEAR(studentP(2.2281389, 10), 0.05, 1e-8);
    EXPECT_NEAR(studentP(2.7499957, 30), 0.01, 1e-8);
    EXPECT_EQ(studentP(0, 5), 1);
    EXPECT_EQ(studentP(std::numeric_limits<double>::infinity(), 5), 0);
    for (const double t : {0.1, 1.0, 7.0, 1e4}) // far out, too
    {
        expectClose(studentP(t, 1), 2 / kPi * std::atan(1 / t));
        expectClose(studentP(-t, 2), 2 / (2 + t * t) / (1 + t / std::sqrt(2 + t * t)), 1e-11);
    }
    EXPECT_NEAR(studentP(2, 1e7), std::erfc(2 / std::numbers::sqrt2), 1e-7); // the normal distribution's
}

TEST(Distributions, ChiSquaredTailIsThatOfTheTables)
{
    EXPECT_NEAR(chiSquaredP(3.84145882, 1), 0.05, 1e-9);
    EXPECT_NEAR(chiSquaredP(18.3070381, 10), 0.05, 1e-9);
    EXPECT_NEAR(chiSquaredP(135.806723, 100), 0.01, 1e-9);
}

TEST(Distributions, SidaksThresholdKeepsTheChanceOfAnyFailure)
{
    EXPECT_DOUBLE_EQ(sidakThreshold(0.01, 1), 0.01);
    for (const uint64_t n : {2u, 100u, 1000000u})
        EXPECT_NEAR(-std::expm1(double(n) * std::log1p(-sidakThreshold(0.01, n))), 0.01, 1e-12) << n;
}

} // namespace
