#include "tools/compare/metrics.h"

#include "format/check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace
{

double square(double x)
{
    return x * x;
}

void setMeans(const ImageF& reference, const ImageF& test, Metrics& metrics)
{
    const double pixel_count = double(reference.pixelCount());
    for (size_t i = 0; i < reference.rgb.size(); ++i)
    {
        metrics.reference_mean[i % 3] += double(reference.rgb[i]) / pixel_count;
        metrics.test_mean[i % 3] += double(test.rgb[i]) / pixel_count;
    }
    for (size_t i = 0; i < 3; ++i)
    {
        const double r = metrics.reference_mean[i], t = metrics.test_mean[i];
        metrics.mean_ratio[i] = r != 0 ? t / r : t == 0 ? 1.0 : std::numeric_limits<double>::infinity();
    }
}

void setErrors(const ImageF& reference, const ImageF& test, Metrics& metrics)
{
    std::vector<double> relative(reference.pixelCount()); // per pixel, mean over channels
    double squares = 0, differences = 0, sum = 0;
    for (size_t i = 0; i < reference.rgb.size(); ++i)
    {
        const double r = double(reference.rgb[i]);
        const double difference = square(double(test.rgb[i]) - r);
        squares += difference;
        differences += std::abs(double(test.rgb[i]) - r);
        sum += r;
        relative[i / 3] += difference / (square(r) + kRelMseEpsilon) / 3.0;
    }
    metrics.rmse = std::sqrt(squares / double(reference.rgb.size()));
    if (differences > 0)
        metrics.mean_difference = sum > 0 ? differences / sum : std::numeric_limits<double>::infinity();

    const size_t worst_count = (relative.size() + 999) / 1000;
    const size_t kept = std::max<size_t>(relative.size() - worst_count, 1);
    const auto cut = relative.begin() + std::ptrdiff_t(kept);
    std::nth_element(relative.begin(), cut - 1, relative.end());
    const double best = std::accumulate(relative.begin(), cut, 0.0);
    metrics.relmse_trimmed = best / double(kept);
    metrics.relmse = std::accumulate(cut, relative.end(), best) / double(relative.size());
}

/// Errors of neighbouring pixels may be correlated, those of blocks hardly: the standard error is computed from blocks.
void setBias(const ImageF& reference, const ImageF& test, Metrics& metrics)
{
    const uint32_t columns = std::min(16u, reference.width);
    const uint32_t rows = std::min(16u, reference.height);
    std::vector<double> sums(size_t(columns) * rows), counts(sums.size());
    for (uint32_t y = 0; y < reference.height; ++y)
    {
        for (uint32_t x = 0; x < reference.width; ++x)
        {
            const size_t block =
                uint64_t(y) * rows / reference.height * columns + uint64_t(x) * columns / reference.width;
            const size_t pixel = 3 * (size_t(y) * reference.width + x);
            for (size_t i = 0; i < 3; ++i)
                sums[block] += double(test.rgb[pixel + i]) - double(reference.rgb[pixel + i]);
            counts[block] += 3;
        }
    }
    double mean = 0, spread = 0;
    for (size_t i = 0; i < sums.size(); ++i)
        mean += sums[i] / counts[i] / double(sums.size());
    for (size_t i = 0; i < sums.size(); ++i)
        spread += square(sums[i] / counts[i] - mean);
    metrics.block_count = uint32_t(sums.size());
    if (sums.size() < 2)
        return;
    const double standard_error = std::sqrt(spread / double(sums.size() - 1) / double(sums.size()));
    if (standard_error > 0)
        metrics.bias_z = mean / standard_error;
    else if (mean != 0)
        metrics.bias_z = std::copysign(std::numeric_limits<double>::infinity(), mean);
}

} // namespace

uint64_t blackenNonFinite(ImageF& image)
{
    uint64_t count = 0;
    for (size_t i = 0; i < image.rgb.size(); i += 3)
    {
        if (std::isfinite(image.rgb[i]) && std::isfinite(image.rgb[i + 1]) && std::isfinite(image.rgb[i + 2]))
            continue;
        std::fill_n(image.rgb.begin() + std::ptrdiff_t(i), 3, 0.0f);
        ++count;
    }
    return count;
}

Metrics compareImages(const ImageF& reference, const ImageF& test)
{
    check(reference.width == test.width && reference.height == test.height && reference.pixelCount() > 0,
          "{} x {} and {} x {}", reference.width, reference.height, test.width, test.height);
    Metrics metrics;
    setMeans(reference, test, metrics);
    setErrors(reference, test, metrics);
    setBias(reference, test, metrics);
    return metrics;
}
