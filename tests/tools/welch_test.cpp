// Welch's test of sets of pictures: false alarms and power on synthetic noise, known values, and its edges.
#include "tests/tools/random_image.h"
#include "tools/compare/distributions.h"
#include "tools/compare/picture.h"
#include "tools/compare/welch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

/// `count` pictures whose pixels are independent and normally distributed.
std::vector<ImageF> noisy(std::mt19937& random, size_t count, uint32_t side, float mean, float deviation)
{
    std::normal_distribution<float> normal(mean, deviation);
    std::vector<ImageF> images;
    for (size_t i = 0; i < count; ++i)
    {
        images.push_back({side, side, {}});
        for (size_t k = 0; k < 3 * images.back().pixelCount(); ++k)
            images.back().rgb.push_back(normal(random));
    }
    return images;
}

double shareBelow(const WelchResult& result, double p)
{
    return double(std::ranges::count_if(result.tests, [&](const WelchTest& t) { return t.p < p; })) /
           double(result.tests.size());
}

TEST(Welch, GivesKnownValues)
{
    // Differences and variances by hand: means 3 and 6, variances 2.5 and 10 over n = 5: t = -3 / sqrt(0.5 + 2).
    const std::vector<double> a{1, 2, 3, 4, 5}, b{2, 4, 6, 8, 10};
    const double degrees = 2.5 * 2.5 / (0.5 * 0.5 / 4 + 2.0 * 2.0 / 4);
    EXPECT_NEAR(degrees, 5.88235, 1e-5);
    EXPECT_NEAR(welchP(a, b), studentP(3 / std::sqrt(2.5), degrees), 1e-14);
    EXPECT_NEAR(welchP(b, a), 0.107531195, 1e-8); // Student's density integrated by the midpoint rule
    // One degree of freedom a side and equal variances: two, whose tail is a closed form. t = 2 / sqrt(0.25 + 0.25).
    const double t = 2 / std::sqrt(0.5);
    EXPECT_NEAR(welchP(std::vector<double>{0, 1}, std::vector<double>{2, 3}), 1 - t / std::sqrt(2 + t * t), 1e-12);
}

/// The rate of false alarms is the level, to 4 standard deviations of a binomial count.
TEST(Welch, RaisesFalseAlarmsAtTheStatedLevel)
{
    std::mt19937 random(1);
    const WelchResult result = welch(noisy(random, 6, 128, 1, 0.1f), noisy(random, 9, 128, 1, 0.3f), 2);
    const double count = double(result.tests.size());
    ASSERT_GE(count, 12000);
    for (const double level : {0.5, 0.1, 0.05, 0.01})
        EXPECT_NEAR(shareBelow(result, level), level, 4 * std::sqrt(level * (1 - level) / count)) << level;
}

/// Of whole comparisons, too: of 400 without any difference about 5 % are found to differ at that level.
TEST(Welch, FindsADifferenceWhereThereIsNoneAsOftenAsAskedFor)
{
    std::mt19937 random(2);
    constexpr int kTrials = 400;
    int found = 0;
    for (int trial = 0; trial < kTrials; ++trial)
        found += welch(noisy(random, 8, 8, 1, 0.1f), noisy(random, 8, 8, 1, 0.2f), 2, 0.05).differ();
    EXPECT_NEAR(found, 0.05 * kTrials, 4 * std::sqrt(0.05 * 0.95 * kTrials));
}

/// A shift of one tile by 12 standard errors of the difference is hard to miss: with 14 degrees of freedom and 51 tests
/// t must reach 5.9, so that a chance of 6 deviations would have to hide it. Half a standard error may not be seen.
TEST(Welch, FindsAKnownShiftAndWhereItIs)
{
    std::mt19937 random(3);
    constexpr float kDeviation = 0.1f;
    constexpr uint32_t kTile = 4, kSide = 16;
    auto a = noisy(random, 8, kSide, 1, kDeviation);
    const auto b = noisy(random, 8, kSide, 1, kDeviation);
    EXPECT_FALSE(welch(a, b, kTile).differ());
    const float standard_error = kDeviation / std::sqrt(float(kTile * kTile)) * std::sqrt(2.0f / 8);
    for (ImageF& image : a)
        for (uint32_t y = 8; y < 12; ++y)
            for (uint32_t x = 4; x < 8; ++x)
                image.rgb[3 * (y * kSide + x) + 1] -= 12 * standard_error;
    const WelchResult result = welch(a, b, kTile);
    EXPECT_EQ(result.tests.size(), 51u);
    EXPECT_TRUE(result.differ());
    EXPECT_FALSE(result.smallest.is_whole);
    EXPECT_EQ(result.smallest.tile_x, 1u);
    EXPECT_EQ(result.smallest.tile_y, 2u);
    EXPECT_EQ(result.smallest.channel, 1u);
    EXPECT_NEAR(result.smallest.difference, -12 * standard_error, 5 * standard_error);
    EXPECT_LT(result.smallest.p, result.threshold);
    const Picture map = pValueMap(result);
    EXPECT_EQ(map.width, 4u);
    EXPECT_EQ((std::vector<uint8_t>(map.rgb.begin() + 3 * 9, map.rgb.begin() + 3 * 10)),
              (std::vector<uint8_t>{0, 0, 255}));
}

TEST(Welch, SeesInTheWholePictureWhatNoTileShows)
{
    // 0.5 standard errors of a tile's mean are 8 of the whole picture's, which has 256 times as many pixels.
    std::mt19937 random(4);
    const auto a = noisy(random, 8, 64, 1.0125f, 0.2f), b = noisy(random, 8, 64, 1, 0.2f);
    const WelchResult result = welch(a, b, 4);
    EXPECT_TRUE(result.differ());
    EXPECT_TRUE(result.smallest.is_whole);
    for (size_t c = 0; c < 3; ++c)
    {
        EXPECT_NEAR(result.ratio_error[c], std::sqrt(2.0) * 0.2 / std::sqrt(64 * 64 * 8), 0.0006);
        EXPECT_NEAR(result.mean_ratio[c], 1.0125, 4 * result.ratio_error[c]);
    }
}

TEST(Welch, TilesWithoutNoiseAreEqualOrNot)
{
    const auto set = [](float red) { return std::vector<ImageF>(3, constantImage(9, 5, red, 0, 2)); };
    const WelchResult equal = welch(set(0.1f), set(0.1f)), rounded = welch(set(0.1f), set(0.1f * (1 + 3e-6f)));
    EXPECT_FALSE(equal.differ());
    EXPECT_EQ(equal.smallest.p, 1);
    EXPECT_FALSE(rounded.differ());
    EXPECT_EQ(equal.columns, 2u); // the last of one column of pixels
    EXPECT_EQ(equal.mean_ratio, (std::array<double, 3>{1, 1, 1}));
    const WelchResult other = welch(set(0.1f), set(0.10001f));
    EXPECT_EQ(other.smallest.p, 0);
    EXPECT_EQ(other.below_count, 3u); // red of both tiles and of the whole
    // Noise on one side alone is a one-sample test.
    std::mt19937 random(5);
    EXPECT_FALSE(welch(noisy(random, 6, 8, 1, 0.1f), std::vector<ImageF>(2, constantImage(8, 8, 1, 1, 1))).differ());
}

TEST(Welch, ABugInTheCallAborts)
{
    const std::vector<ImageF> one(1, constantImage(4, 4, 1, 1, 1)), two(2, one[0]),
        wide(2, constantImage(8, 4, 1, 1, 1));
    EXPECT_DEATH(welch(one, two), "1 and 2 pictures");
    EXPECT_DEATH(welch(two, wide), "8 x 4 and 4 x 4");
}

} // namespace
