// Tests whether two ways of rendering give the same picture, from several pictures of each.
#pragma once
#include "image/image.h"

#include <array>
#include <span>

/// Means with a smaller relative difference are equal: the rounding error of a sum of 64 floats.
inline constexpr double kWelchRounding = 64 / 16777216.0;

/// Welch's t-test (Welch 1947) of the mean of a tile, or of the whole picture, in one channel.
struct WelchTest
{
    double p = 1;          // probability of a difference at least this large if both sets had one mean
    double difference = 0; // mean of set a - mean of set b
    uint32_t tile_x = 0;   // in tiles; 0 for the whole picture
    uint32_t tile_y = 0;
    uint32_t channel = 0;  // 0 red, 1 green, 2 blue
    bool is_whole = false; // of the whole picture
};

struct WelchResult
{
    uint32_t tile = 0;              // side of a tile in pixels; those at the right and lower edge may be smaller
    uint32_t columns = 0, rows = 0; // of tiles
    std::vector<WelchTest>
        tests;                // [3 * (columns * rows + 1)]: channels of each tile, row by row; the whole picture last
    double threshold = 0;     // p of a single test below which the sets differ: Sidak's, for that many tests
    uint32_t below_count = 0; // tests with p < threshold
    WelchTest smallest;       // the test with the smallest p
    std::array<double, 3> mean_a{}, mean_b{};          // of all pictures of a set
    std::array<double, 3> mean_ratio{}, ratio_error{}; // mean_a / mean_b (1 where both are 0) and its standard error

    bool differ() const { return below_count > 0; }
};

/// Tests every channel of every tile of `tile` x `tile` pixels, and of the whole picture, for a difference of the two
/// sets' means. The mean of a tile in one picture is one sample, so that pixels of one picture may depend on each
/// other; the pictures of a set must be independent and of one distribution: equal but for their seeds. Where no
/// picture of either set differs from another one of its set, p is 1 where the sets agree up to rounding, else 0.
/// @param a, b at least 2 pictures each, all of one size, only finite values
/// @param alpha chance, 0..1, that sets without any difference are found to differ; holds for normally distributed
/// means
WelchResult welch(std::span<const ImageF> a, std::span<const ImageF> b, uint32_t tile = 8, double alpha = 0.01);

/// The test itself, on plain numbers: at least 2 samples each. @return p
double welchP(std::span<const double> a, std::span<const double> b);
