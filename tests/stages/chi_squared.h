// Pearson's chi-squared test of what a sampler draws against the density that it should have.
#pragma once
#include "tests/stages/double3.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

struct ChiSquared
{
    double statistic = 0;
    uint32_t degrees = 0;
    double p = 1;
};

/// Counts against expected counts; both add up to the same. Cells that expect fewer than 5 are taken together.
ChiSquared chiSquared(const std::vector<double>& counts, const std::vector<double>& expected);

/// Tests of several samplers that together fail by accident with a chance of 1 % (Sidak).
class ChiSquaredTests
{
public:
    void add(const std::string& what, const ChiSquared& test);
    /// Prints all of them, and expects none to fail. (Call it once, at the end.)
    void expectAll() const;

private:
    struct Named
    {
        std::string what;
        ChiSquared test;
    };
    std::vector<Named> tests_;
};

/// Cells over the sphere of directions: rings around an axis, narrow near it, and slices about it.
class SphereGrid
{
public:
    /// @param axis unit
    /// @param width about 1 - cos of the angle within which half of the rings lie; large: rings of equal solid angle
    SphereGrid(Double3 axis, double width);

    /// One count a cell, and those that were absorbed last: the rest of 1 in what integrate() gives.
    uint32_t cellCount() const { return kRings * kSlices + 1; }
    uint32_t absorbedCell() const { return kRings * kSlices; }
    uint32_t cellOf(Double3 direction) const;
    /// Integral over each cell, halved each way until Simpson's rule settles. @param density per steradian; may jump
    std::vector<double> integrate(const std::function<double(Double3)>& density) const;

private:
    static constexpr uint32_t kRings = 12, kSlices = 12;

    struct Patch // from first to last in s and phi, see the code
    {
        double s0, s1, phi0, phi1;
    };
    double simpson(const std::function<double(Double3)>& density, const Patch& patch, uint32_t steps) const;
    double integral(const std::function<double(Double3)>& density, const Patch& patch, double tolerance,
                    uint32_t depth) const;

    Double3 axis_, side_, up_;
    double width_;
};
