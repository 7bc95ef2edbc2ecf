// Fits a line of colours to texels of a block: endpoints, an index a texel and the error that is left.
#pragma once
#include "compiler/lanes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace bc7
{
template <size_t N>
using Color = std::array<float, N>; // 0 to 255

template <size_t N>
struct Line
{
    Color<N> first{}, second{};
};

/// Indices of texels on a line, and what is left between the texels and their places on it.
struct Places
{
    Lanes indices; // 0 .. steps
    Lanes weights; // of the second endpoint, 0 to 1
    float error;   // sum of squares
};

/// The line through the mean along which the colours vary most (by power iteration), as far as they reach.
/// @param mask 1 for the texels that count, else 0
template <size_t N>
Line<N> principalLine(const std::array<Lanes, N>& c, const Lanes& mask)
{
    const float inverse_count = 1 / sum(mask);
    Color<N> mean;
    std::array<Lanes, N> centered;
    for (size_t k = 0; k < N; ++k)
    {
        mean[k] = sum(c[k] * mask) * inverse_count;
        centered[k] = (c[k] - mean[k]) * mask;
    }
    std::array<Color<N>, N> covariance;
    size_t widest = 0;
    for (size_t k = 0; k < N; ++k)
    {
        for (size_t j = k; j < N; ++j)
            covariance[k][j] = covariance[j][k] = sum(centered[k] * centered[j]);
        if (covariance[k][k] > covariance[widest][widest])
            widest = k;
    }
    Color<N> axis = covariance[widest];
    for (int iteration = 0; iteration < 4; ++iteration)
    {
        Color<N> next{};
        float largest = 0;
        for (size_t k = 0; k < N; ++k)
        {
            for (size_t j = 0; j < N; ++j)
                next[k] += covariance[k][j] * axis[j];
            largest = std::max(largest, std::fabs(next[k]));
        }
        if (largest < 1e-12f)
            break;
        for (size_t k = 0; k < N; ++k)
            axis[k] = next[k] / largest;
    }
    float squared = 0;
    for (const float a : axis)
        squared += a * a;
    Line<N> line{mean, mean};
    if (squared < 1e-12f)
        return line;
    Lanes along = centered[0] * axis[0];
    for (size_t k = 1; k < N; ++k)
        along = along + centered[k] * axis[k];
    const float low = least(along) / squared, high = greatest(along) / squared; // masked texels lie at 0, between them
    for (size_t k = 0; k < N; ++k)
    {
        line.first[k] = std::clamp(mean[k] + low * axis[k], 0.0f, 255.0f);
        line.second[k] = std::clamp(mean[k] + high * axis[k], 0.0f, 255.0f);
    }
    return line;
}

/// The nearest of steps + 1 places for every texel.
template <size_t N>
Places place(const std::array<Lanes, N>& c, const Lanes& mask, const Line<N>& line, int steps)
{
    Color<N> way;
    float squared = 0;
    for (size_t k = 0; k < N; ++k)
    {
        way[k] = line.second[k] - line.first[k];
        squared += way[k] * way[k];
    }
    const float scale = squared > 0 ? float(steps) / squared : 0;
    std::array<Lanes, N> offset;
    Lanes along = Lanes::all(0);
    for (size_t k = 0; k < N; ++k)
    {
        offset[k] = c[k] - line.first[k];
        along = along + offset[k] * (way[k] * scale);
    }
    Places places;
    places.indices = rounded(clamp(along, 0, float(steps)));
    places.weights = rounded(places.indices * (64.0f / float(steps))) * (1.0f / 64); // as in bc7_tables.h
    Lanes error = Lanes::all(0);
    for (size_t k = 0; k < N; ++k)
    {
        const Lanes left = offset[k] - places.weights * way[k];
        error = error + left * left;
    }
    places.error = sum(error * mask);
    return places;
}

/// The best endpoints for the present indices (least squares).
template <size_t N>
Line<N> refit(const std::array<Lanes, N>& c, const Lanes& mask, const Places& places, const Line<N>& line)
{
    const Lanes second = places.weights * mask, first = mask - second;
    const float aa = sum(first * first), ab = sum(first * second), bb = sum(second * second);
    const float determinant = aa * bb - ab * ab;
    if (determinant < 1e-3f)
        return line;
    Line<N> out;
    for (size_t k = 0; k < N; ++k)
    {
        const float ac = sum(first * c[k]), bc = sum(second * c[k]);
        out.first[k] = std::clamp((ac * bb - bc * ab) / determinant, 0.0f, 255.0f);
        out.second[k] = std::clamp((bc * aa - ac * ab) / determinant, 0.0f, 255.0f);
    }
    return out;
}

/// Quantizes, assigns indices and refits until the error no longer falls.
/// @param quantize Line -> a struct with the line as it will be decoded in its member `line`
template <size_t N, typename Quantize>
auto fitLine(const std::array<Lanes, N>& c, const Lanes& mask, int steps, int refits, const Quantize& quantize)
{
    struct Fit
    {
        decltype(quantize(Line<N>{})) ends;
        Places places;
    };
    Line<N> line = principalLine(c, mask);
    Fit best{quantize(line), {}};
    best.places = place(c, mask, best.ends.line, steps);
    for (int i = 0; i < refits; ++i)
    {
        line = refit(c, mask, best.places, line);
        Fit next{quantize(line), {}};
        next.places = place(c, mask, next.ends.line, steps);
        if (!(next.places.error < best.places.error))
            break;
        best = next;
    }
    return best;
}

/// The `out.size()` of the 64 two-subset partitions with the least estimated error, best first (mode 1: no alpha).
void promisingPartitions(const std::array<Lanes, 3>& c, std::span<uint32_t> out);
} // namespace bc7
