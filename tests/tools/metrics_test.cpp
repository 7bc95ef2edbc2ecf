// Error metrics against hand-computed values.
#include "tests/tools/random_image.h"
#include "tools/compare/metrics.h"
#include "tools/compare/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{

TEST(Metrics, IdenticalImagesHaveNoError)
{
    const ImageF image = randomImage(33, 17, 1, 5.0f);
    const Metrics metrics = compareImages(image, image);
    EXPECT_EQ(metrics.rmse, 0);
    EXPECT_EQ(metrics.relmse, 0);
    EXPECT_EQ(metrics.relmse_trimmed, 0);
    EXPECT_EQ(metrics.bias_z, 0);
    for (double ratio : metrics.mean_ratio)
        EXPECT_EQ(ratio, 1);
}

TEST(Metrics, TwoPixelsByHand)
{
    // Differences: 1, 0, 2 and 0, 0, -1.  Squares sum to 6 over 6 values.
    const ImageF reference{2, 1, {1, 2, 0, 3, 4, 1}};
    const ImageF test{2, 1, {2, 2, 2, 3, 4, 0}};
    const Metrics metrics = compareImages(reference, test);
    EXPECT_DOUBLE_EQ(metrics.reference_mean[0], 2);
    EXPECT_DOUBLE_EQ(metrics.test_mean[0], 2.5);
    EXPECT_DOUBLE_EQ(metrics.mean_ratio[0], 1.25);
    EXPECT_DOUBLE_EQ(metrics.mean_ratio[1], 1);
    EXPECT_DOUBLE_EQ(metrics.mean_ratio[2], 2);
    EXPECT_DOUBLE_EQ(metrics.rmse, 1);
    EXPECT_DOUBLE_EQ(metrics.mean_difference, 4.0 / 11);
    const double first = (1 / 1.01 + 4 / 0.01) / 3;
    const double second = (1 / 1.01) / 3;
    EXPECT_NEAR(metrics.relmse, (first + second) / 2, 1e-12 * first);
    EXPECT_NEAR(metrics.relmse_trimmed, second, 1e-12 * second); // the worst 0.1 % is rounded up to one pixel
}

TEST(Metrics, TrimmingDropsExactlyTheFireflies)
{
    // 50 x 40 pixels: 0.1 % are two.
    const ImageF reference = constantImage(50, 40, 1, 1, 1);
    ImageF test = constantImage(50, 40, 1.1f, 1.1f, 1.1f);
    test.rgb[300] = 1e4f;
    test.rgb[900] = 1e4f;
    const Metrics metrics = compareImages(reference, test);
    const double small = std::pow(double(1.1f) - 1, 2) / 1.01;
    EXPECT_NEAR(metrics.relmse_trimmed, small, 1e-9);
    EXPECT_GT(metrics.relmse, 1e4);
}

TEST(Metrics, BiasIsTheMeanOverItsStandardError)
{
    // 2 x 2 pixels are four blocks with differences 1, 2, 3, 6: mean 3, variance 14/3, standard error sqrt(14/12).
    const ImageF reference = constantImage(2, 2, 1, 1, 1);
    const ImageF test{2, 2, {2, 2, 2, 3, 3, 3, 4, 4, 4, 7, 7, 7}};
    const Metrics metrics = compareImages(reference, test);
    EXPECT_EQ(metrics.block_count, 4u);
    EXPECT_NEAR(metrics.bias_z, 3 / std::sqrt(14.0 / 12.0), 1e-12);
}

TEST(Metrics, UnbiasedNoiseStaysWithinThreeStandardErrorsAndBiasDoesNot)
{
    const ImageF reference = constantImage(128, 128, 1, 1, 1);
    ImageF noisy = randomImage(128, 128, 7, 2.0f); // uniform in 0..2: mean 1
    EXPECT_LT(std::abs(compareImages(reference, noisy).bias_z), 3);
    for (float& value : noisy.rgb)
        value *= 1.05f;
    EXPECT_GT(compareImages(reference, noisy).bias_z, 3);
}

TEST(Metrics, NonFinitePixelsAreCountedAndBlackened)
{
    ImageF image = constantImage(3, 1, 1, 2, 3);
    image.rgb[1] = std::numeric_limits<float>::quiet_NaN();
    image.rgb[8] = -std::numeric_limits<float>::infinity();
    EXPECT_EQ(blackenNonFinite(image), 2u);
    EXPECT_EQ(image.rgb, (std::vector<float>{0, 0, 0, 1, 2, 3, 0, 0, 0}));
    EXPECT_EQ(blackenNonFinite(image), 0u);
}

TEST(Picture, ShowsBrighterRedDarkerBlueAndEqualWhite)
{
    const ImageF reference = constantImage(3, 1, 1, 1, 1);
    const ImageF test{3, 1, {1, 1, 1, 9, 9, 9, 0, 0, 0}};
    const FlipMap flip{{0, 1, 0.5f}, 0.5};
    const Picture picture = sideBySide(reference, test, 0.5f, flip);
    EXPECT_EQ(picture.width, 4 * 3 + 3 * 4u);
    EXPECT_EQ(picture.height, 1u);
    const auto pixel = [&](size_t x)
    {
        return std::vector<int>(picture.rgb.begin() + std::ptrdiff_t(3 * x),
                                picture.rgb.begin() + std::ptrdiff_t(3 * x + 3));
    };
    EXPECT_EQ(pixel(0), (std::vector<int>{188, 188, 188})); // sRGB of 0.5
    EXPECT_EQ(pixel(3), (std::vector<int>{128, 128, 128})); // the gap
    EXPECT_EQ(pixel(8), (std::vector<int>{255, 255, 255})); // test, 9 * 0.5
    EXPECT_EQ(pixel(14), (std::vector<int>{255, 255, 255}));
    EXPECT_EQ(pixel(15), (std::vector<int>{255, 0, 0}));
    EXPECT_EQ(pixel(16), (std::vector<int>{0, 0, 255}));
    const std::vector<int> none = pixel(21), most = pixel(22);
    EXPECT_LT(none[0] + none[1] + none[2], 20);
    EXPECT_GT(most[0] + most[1], 480);
}

} // namespace
