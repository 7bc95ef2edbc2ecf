// Error metrics of a rendering against its reference.
#pragma once
#include "image/image.h"

#include <array>

/// The constant of relMSE, which bounds the weight of black pixels. (W/(m^2 sr))^2
inline constexpr double kRelMseEpsilon = 0.01;

struct Metrics
{
    uint64_t reference_nonfinite = 0; // pixels with a not-a-number or an infinity
    uint64_t test_nonfinite = 0;
    std::array<double, 3> reference_mean{}; // per channel
    std::array<double, 3> test_mean{};
    std::array<double, 3> mean_ratio{}; // test / reference; 1 where both are 0
    double rmse = 0;                    // sqrt(mean((t - r)^2)) over pixels and channels
    double relmse = 0;                  // mean((t - r)^2 / (r^2 + kRelMseEpsilon)) over pixels and channels
    double relmse_trimmed = 0;          // the same without the worst 0.1 % of the pixels (rounded up to whole pixels)
    double mean_difference = 0;         // mean(|t - r|) / mean(r) over pixels and channels; 0 where both are black
    double bias_z = 0;        // mean over block_count blocks of (block mean of t - r), divided by its standard error;
                              // beyond +-3 the means differ by more than noise explains
    uint32_t block_count = 0; // up to 16 x 16
};

/// Sets every pixel that is not finite to black and returns how many there were.
uint64_t blackenNonFinite(ImageF& image);

/// Both images must have the same size and only finite values. The two *_nonfinite counts are left 0.
Metrics compareImages(const ImageF& reference, const ImageF& test);
