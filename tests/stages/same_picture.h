// Tests whether two unbiased ways of rendering give the same picture, from several pictures of each.
#pragma once
#include "format/gpu_types.h"
#include "tools/compare/welch.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

/// @param pixels vec3[width * height], rows from the top
inline ImageF imageOf(uint32_t width, uint32_t height, const std::vector<gpu::vec3>& pixels)
{
    ImageF image{.width = width, .height = height, .rgb = {}};
    for (const gpu::vec3& p : pixels)
        image.rgb.insert(image.rgb.end(), {p.x, p.y, p.z});
    return image;
}

/// Expects two sets, each of pictures with seeds of their own, to differ by noise alone, in every tile and as a whole.
/// @param largest_error that the ratio of their means may have: with more noise the comparison would be meaningless
inline void expectSamePicture(const std::string& what, std::span<const ImageF> a, std::span<const ImageF> b,
                              double largest_error)
{
    const WelchResult result = welch(a, b);
    fmt::print("  {}: mean ratio {:.4f} +- {:.4f}, smallest p {:.2g} of {} tests, threshold {:.2g}\n", what,
               result.mean_ratio[1], result.ratio_error[1], result.smallest.p, result.tests.size(), result.threshold);
    EXPECT_FALSE(result.differ()) << what << ": tile " << result.smallest.tile_x << ", " << result.smallest.tile_y
                                  << ", p " << result.smallest.p;
    for (const double error : result.ratio_error)
        EXPECT_LE(error, largest_error) << what << ": too few samples to tell";
}
