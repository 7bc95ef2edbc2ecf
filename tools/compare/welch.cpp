#include "tools/compare/welch.h"

#include "format/check.h"
#include "tools/compare/distributions.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{

struct Moments
{
    double mean = 0;
    double variance = 0; // of the mean
    double degrees = 0;
};

/// Relative to the first sample: equal samples have a variance of exactly 0.
Moments momentsOf(std::span<const double> samples)
{
    const double n = double(samples.size());
    double sum = 0, squares = 0;
    for (const double sample : samples)
        sum += sample - samples[0];
    for (const double sample : samples)
        squares += std::pow(sample - samples[0] - sum / n, 2);
    return {.mean = samples[0] + sum / n, .variance = squares / (n - 1) / n, .degrees = n - 1};
}

double pOf(const Moments& a, const Moments& b)
{
    const double difference = std::abs(a.mean - b.mean);
    if (difference <= kWelchRounding * std::max(std::abs(a.mean), std::abs(b.mean)))
        return 1;
    const double variance = a.variance + b.variance;
    if (variance == 0)
        return 0;
    // Welch 1947 and Satterthwaite 1946, divided by the variance so that tiny ones do not vanish.
    const double part_a = a.variance / variance, part_b = b.variance / variance;
    const double degrees = 1 / (part_a * part_a / a.degrees + part_b * part_b / b.degrees);
    return studentP(difference / std::sqrt(variance), degrees);
}

/// Means of tiles, [3 * columns * rows], channels of each tile, row by row.
std::vector<double> tileMeans(const ImageF& image, uint32_t tile, uint32_t columns, uint32_t rows)
{
    std::vector<double> sums(size_t(3) * columns * rows), counts(sums.size());
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x)
            for (size_t c = 0; c < 3; ++c)
            {
                const size_t i = 3 * (size_t(y / tile) * columns + x / tile) + c;
                sums[i] += double(image.rgb[3 * (size_t(y) * image.width + x) + c]);
                counts[i] += 1;
            }
    for (size_t i = 0; i < sums.size(); ++i)
        sums[i] /= counts[i];
    return sums;
}

/// One vector a tile and channel, the whole picture's last: its mean in each picture.
std::vector<std::vector<double>> samplesOf(std::span<const ImageF> images, const WelchResult& result)
{
    std::vector<std::vector<double>> samples(3 * (size_t(result.columns) * result.rows + 1));
    for (const ImageF& image : images)
    {
        std::vector<double> means = tileMeans(image, result.tile, result.columns, result.rows);
        const std::vector<double> whole = tileMeans(image, std::max(image.width, image.height), 1, 1);
        means.insert(means.end(), whole.begin(), whole.end());
        for (size_t i = 0; i < means.size(); ++i)
            samples[i].push_back(means[i]);
    }
    return samples;
}

/// First-order propagation of errors for a ratio of independent means.
void setRatio(const Moments& a, const Moments& b, size_t channel, WelchResult& result)
{
    result.mean_a[channel] = a.mean;
    result.mean_b[channel] = b.mean;
    const double infinity = std::numeric_limits<double>::infinity();
    result.mean_ratio[channel] = b.mean != 0 ? a.mean / b.mean : a.mean == 0 ? 1.0 : infinity;
    result.ratio_error[channel] =
        b.mean != 0 ? std::sqrt(a.variance + std::pow(result.mean_ratio[channel], 2) * b.variance) / std::abs(b.mean)
                    : 0.0;
}

void checkImages(std::span<const ImageF> a, std::span<const ImageF> b)
{
    check(a.size() >= 2 && b.size() >= 2, "{} and {} pictures", a.size(), b.size());
    for (const std::span<const ImageF> images : {a, b})
        for (const ImageF& image : images)
            check(image.width == a[0].width && image.height == a[0].height && image.pixelCount() > 0,
                  "{} x {} and {} x {}", image.width, image.height, a[0].width, a[0].height);
}

} // namespace

double welchP(std::span<const double> a, std::span<const double> b)
{
    check(a.size() >= 2 && b.size() >= 2, "{} and {} samples", a.size(), b.size());
    return pOf(momentsOf(a), momentsOf(b));
}

WelchResult welch(std::span<const ImageF> a, std::span<const ImageF> b, uint32_t tile, double alpha)
{
    checkImages(a, b);
    check(tile > 0, "tiles of no size");
    WelchResult result;
    result.tile = tile;
    result.columns = (a[0].width + tile - 1) / tile;
    result.rows = (a[0].height + tile - 1) / tile;
    const auto samples_a = samplesOf(a, result), samples_b = samplesOf(b, result);
    result.threshold = sidakThreshold(alpha, samples_a.size());
    for (size_t i = 0; i < samples_a.size(); ++i)
    {
        const Moments moments_a = momentsOf(samples_a[i]), moments_b = momentsOf(samples_b[i]);
        const auto place = uint32_t(i / 3), channel = uint32_t(i % 3);
        const bool is_whole = place == result.columns * result.rows;
        if (is_whole)
            setRatio(moments_a, moments_b, channel, result);
        result.tests.push_back({.p = pOf(moments_a, moments_b),
                                .difference = moments_a.mean - moments_b.mean,
                                .tile_x = is_whole ? 0 : place % result.columns,
                                .tile_y = is_whole ? 0 : place / result.columns,
                                .channel = channel,
                                .is_whole = is_whole});
        result.below_count += result.tests.back().p < result.threshold;
    }
    result.smallest = *std::ranges::min_element(result.tests, {}, &WelchTest::p);
    return result;
}
