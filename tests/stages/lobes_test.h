// Draws from materials with layers, and what tests of them share.
#pragma once
#include "tests/stages/sampling_test.h"

inline gpu::vec3 viewer(double degrees)
{
    const double angle = degrees * std::numbers::pi / 180, turn = 0.7; // no symmetry hides a mistake in x or y
    return {float(std::sin(angle) * std::cos(turn)), float(std::sin(angle) * std::sin(turn)), float(std::cos(angle))};
}

inline double square(double x)
{
    return x * x;
}

inline constexpr double kUnit =
    0x1p-24; // half of the last place of 1: what rounding one result to single precision may add
/// Of a result of some tens of operations on numbers up to 1.
inline constexpr double kTensOfRoundings = 32 * kUnit;

/// Walter et al. 2007 and Heitz 2018 for unequal widths.
inline double visibleNormals(double along, double across, Double3 wo, Double3 h)
{
    if (h.z <= 0 || dot(wo, h) <= 0)
        return 0;
    const double d = square(h.x / along) + square(h.y / across) + h.z * h.z;
    const double lambda = (std::sqrt(1 + (square(along * wo.x) + square(across * wo.y)) / (wo.z * wo.z)) - 1) / 2;
    return dot(wo, h) / (wo.z * (1 + lambda) * std::numbers::pi * along * across * d * d);
}

struct Mean
{
    double value = 0, error = 0; // standard
};

inline Mean meanOf(const std::vector<double>& values)
{
    double sum = 0, squares = 0;
    for (const double v : values)
        sum += v, squares += v * v;
    const double n = double(values.size()), mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
}

class Lobes : public Sampling
{
protected:
    /// A black surface without lobes: what a test adds is all there is.
    static gpu::BsdfDrawParams none(double degrees)
    {
        return {.count = kDraws,
                .seed = 0,
                .what = gpu::kDrawDirections,
                .front = 1,
                .flags = 0,
                .base_color = 0,
                .metallic = 0,
                .roughness = 1,
                .transmission = 0,
                .specular = 0,
                .ior = 1.5f,
                .wo = viewer(degrees),
                .clearcoat = 0,
                .clearcoat_roughness = 0,
                .sheen = 0,
                .sheen_roughness = 0,
                .anisotropy = 0,
                .iridescence = 0,
                .film_ior = 1.3f,
                .film_thickness = 0,
                .diffuse_transmission = 0,
                .dispersion = 0,
                .clearcoat_normal = {0, 0, 1}};
    }
    static gpu::BsdfDrawParams white(double degrees)
    {
        gpu::BsdfDrawParams params = none(degrees);
        params.base_color = 1;
        return params;
    }

    std::vector<gpu::BsdfDraw> drawn(gpu::BsdfDrawParams params, uint32_t what = gpu::kDrawDirections)
    {
        params.what = what;
        params.seed = ++seed_;
        return draw<gpu::BsdfDraw>(testKernel("draw/bsdf"), anyScene(), params);
    }

    /// Share of a white sky all around that comes back, from chosen directions.
    Mean albedo(const gpu::BsdfDrawParams& params)
    {
        std::vector<double> weights;
        for (const gpu::BsdfDraw& d : drawn(params))
            weights.push_back(d.weight.x);
        return meanOf(weights);
    }

    /// The same from even directions: nothing of the sampler takes part. Without deltas.
    Mean evenAlbedo(const gpu::BsdfDrawParams& params)
    {
        std::vector<double> values;
        for (const gpu::BsdfDraw& d : drawn(params, gpu::kDrawValues))
            values.push_back(4 * kPi * d.weight.x * std::abs(d.direction.z));
        return meanOf(values);
    }

    /// Draws of a single lobe above the surface against its density.
    void addDraws(ChiSquaredTests& tests, const std::string& what, const gpu::BsdfDrawParams& params, double width,
                  const std::function<double(Double3)>& density)
    {
        const gpu::vec3 wo = params.wo;
        const SphereGrid grid({-wo.x, -wo.y, wo.z}, width);
        std::vector<double> counts(grid.cellCount());
        for (const gpu::BsdfDraw& d : drawn(params))
            ++counts[d.pdf > 0 ? grid.cellOf(d.direction) : grid.absorbedCell()];
        tests.add(what, chiSquared(counts, times(kDraws, grid.integrate(density))));
    }

    uint32_t seed_ = 1000;
};
