// Tail probabilities of the distributions that statistical tests compare with.
#pragma once
#include <cstdint>

/// Regularised incomplete beta function I_x(a, b) for a, b > 0 and x in 0..1, to 1e-12 for a and b below 1e5.
/// By its continued fraction (DLMF 8.17.22).
double regularisedBeta(double a, double b, double x);

/// Regularised upper incomplete gamma function Q(a, x) for a > 0 and x >= 0, to 1e-12 for a below 1e5. By its power
/// series (DLMF 8.11.4) below x = a + 1, by its continued fraction (DLMF 8.9.2) above.
double regularisedGammaQ(double a, double x);

/// Probability that |T| >= |t| for T of Student's distribution with `degrees` > 0 degrees of freedom, which may be a
/// fraction.
double studentP(double t, double degrees);

/// Probability that X >= `statistic` for X of the chi-squared distribution with `degrees` > 0 degrees of freedom.
double chiSquaredP(double statistic, double degrees);

/// Significance level of each of `test_count` >= 1 tests with which the chance that any of them fails by accident is
/// `alpha`: 1 - (1 - alpha)^(1/n) (Sidak 1967). Exact for independent tests, safe for tests that go together.
double sidakThreshold(double alpha, uint64_t test_count);
