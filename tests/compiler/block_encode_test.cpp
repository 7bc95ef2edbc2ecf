// What the encoders make, decoded: errors are those of the formats' quantisation.
#include "compiler/bc4_encode.h"
#include "compiler/bc7_encode.h"
#include "format/block_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace
{
using Channels = std::array<Lanes, 4>;

blocks::Texels throughBc7(const Channels& c, bool uses_alpha)
{
    std::array<std::byte, 16> block{};
    encodeBc7(c, uses_alpha, block);
    return blocks::decodeBc7(block);
}

template <typename Texel>
Channels makeChannels(const Texel& texel)
{
    Channels c;
    for (size_t i = 0; i < 16; ++i)
    {
        const std::array<float, 4> t = texel(i);
        for (size_t k = 0; k < 4; ++k)
            c[k].set(i, t[k]);
    }
    return c;
}

double rootMeanSquare(const Channels& c, const blocks::Texels& got, size_t channels)
{
    double sum = 0;
    for (size_t i = 0; i < 16; ++i)
        for (size_t k = 0; k < channels; ++k)
            sum += std::pow(double(c[k][i]) - got[i][k], 2);
    return std::sqrt(sum / double(16 * channels));
}

/// Channels share the lowest bit of an endpoint: where they disagree in it, one endpoint lies above and the other below, and
/// the places in the middle are the colour itself. Only beside 0 and 255 there is no such endpoint.
TEST(BlockEncode, OneColourIsKept)
{
    std::mt19937 random(1);
    for (int n = 0; n < 600; ++n)
    {
        const uint32_t least = n % 2 == 0 ? 0 : 1;
        std::array<float, 4> color;
        for (float& value : color)
            value = float(least + random() % (256 - 2 * least));
        const bool uses_alpha = n % 3 == 0;
        const Channels c = makeChannels([&](size_t) { return color; });
        const blocks::Texels got = throughBc7(c, uses_alpha);
        for (const auto& t : got)
            for (size_t k = 0; k < (uses_alpha ? 4 : 3); ++k)
                ASSERT_NEAR(t[k], color[k], least == 0 ? 1 : 0);
    }
    const Channels black = makeChannels([](size_t) { return std::array<float, 4>{0, 0, 0, 0}; });
    EXPECT_EQ(throughBc7(black, false)[5][0], 0); // darkness stays dark
}

/// Gradients of whole numbers, each channel with a slope of its own, steep and flat ones: the mean error, its standard error taken
/// from the blocks', is that of the decoder. It adds half a step and cuts off; between endpoints as far apart as those of mode 1
/// (a multiple of 4 steps, weights of at most 2 mod 4 in 64) values have fractions of 1/8 step and come out 1/16 high on average.
TEST(BlockEncode, BlocksAreNeitherBrighterNorDarker)
{
    std::mt19937 random(7);
    for (const float slope : {0.0f, 0.4f, 2.0f, 6.0f})
    {
        constexpr int kBlocks = 4000;
        std::uniform_real_distribution<float> level(24, 231), rise(-slope, slope);
        double sum = 0, squares = 0;
        for (int n = 0; n < kBlocks; ++n)
        {
            std::array<std::array<float, 3>, 3> plane;
            for (auto& channel : plane)
                channel = {level(random), rise(random), rise(random)};
            const Channels c = makeChannels(
                [&](size_t i)
                {
                    std::array<float, 4> texel{0, 0, 0, 255};
                    for (size_t k = 0; k < 3; ++k)
                        texel[k] = std::round(plane[k][0] + plane[k][1] * (float(i % 4) - 1.5f) +
                                              plane[k][2] * (float(i / 4) - 1.5f));
                    return texel;
                });
            double error = 0;
            const blocks::Texels got = throughBc7(c, false);
            for (size_t i = 0; i < 16; ++i)
                for (size_t k = 0; k < 3; ++k)
                    error += got[i][k] - c[k][i];
            error /= 48;
            sum += error, squares += error * error;
        }
        const double mean = sum / kBlocks, standard = std::sqrt((squares / kBlocks - mean * mean) / kBlocks);
        EXPECT_GE(mean, -4.5 * standard) << slope;
        EXPECT_LE(mean, (slope == 0 ? 0 : 1 / 16.0) + 4.5 * standard) << slope;
    }
}

TEST(BlockEncode, AGradientInAllChannelsKeepsToItsLine) // sixteen places for sixteen texels
{
    const Channels c = makeChannels(
        [](size_t i)
        {
            return std::array<float, 4>{10.0f + 14 * float(i), 240.0f - 10 * float(i), 30.0f + 5 * float(i),
                                        255.0f - 8 * float(i)};
        });
    EXPECT_LT(rootMeanSquare(c, throughBc7(c, true), 4), 1.5);
}

TEST(BlockEncode, TwoRegionsOfGradientsWithAnEdgeBetween) // mode 1: 8 places in each, 7 bits an endpoint
{
    const Channels c = makeChannels(
        [](size_t i)
        {
            const float t = float(i / 4);
            return i % 4 < 2 ? std::array<float, 4>{200 + 10 * t, 20, 10 * t, 255}
                             : std::array<float, 4>{10, 60 + 20 * t, 250 - 30 * t, 255};
        });
    EXPECT_LT(rootMeanSquare(c, throughBc7(c, false), 3), 3);
}

TEST(BlockEncode, AlphaByItself) // mode 5: four places for three colours and two alphas
{
    const Channels c = makeChannels(
        [](size_t i)
        {
            return std::array<float, 4>{40.0f + 60 * float(i % 4), 90, 20.0f + 30 * float(i % 4),
                                        i / 4 % 2 == 0 ? 255.0f : 0.0f};
        });
    const blocks::Texels got = throughBc7(c, true);
    EXPECT_LT(rootMeanSquare(c, got, 3), 2.5);
    for (size_t i = 0; i < 16; ++i)
        EXPECT_EQ(got[i][3], i / 4 % 2 == 0 ? 255 : 0);
}

TEST(BlockEncode, AnyBlockIsHeldBetterThanByItsMean)
{
    std::mt19937 random(3);
    double error = 0, variance = 0;
    for (int n = 0; n < 500; ++n)
    {
        const Channels c = makeChannels(
            [&](size_t)
            {
                return std::array<float, 4>{float(random() % 256), float(random() % 256), float(random() % 256),
                                            float(random() % 256)};
            });
        const double e = rootMeanSquare(c, throughBc7(c, n % 2 == 0), n % 2 == 0 ? 4 : 3);
        error += e * e;
        variance += 255.0 * 255 / 12;
    }
    EXPECT_LT(error, 0.75 * variance); // one of four independent channels is followed, more in regions
}

TEST(BlockEncode, OneChannelIsOffByHalfAStepOfItsRange)
{
    std::mt19937 random(5);
    for (int n = 0; n < 500; ++n)
    {
        const float low = float(random() % 200), range = float(random() % 56);
        Lanes values;
        for (size_t i = 0; i < 16; ++i)
            values.set(i, low + range * float(random() % 1001) / 1000);
        std::array<std::byte, 8> block{};
        encodeBc4(values, block);
        const blocks::Texels got = blocks::decodeBc4(block);
        for (size_t i = 0; i < 16; ++i) // half of a seventh; a step for the endpoints, half for the decoder's rounding
            ASSERT_NEAR(got[i][0], values[i], range / 7 + 1.5);
    }
}

TEST(BlockEncode, ExtremesBesideANarrowRangeStay) // six values between 0 and 255 themselves
{
    Lanes values;
    for (size_t i = 0; i < 16; ++i)
        values.set(i, i == 0 ? 0 : i == 1 ? 255 : 100 + float(i));
    std::array<std::byte, 8> block{};
    encodeBc4(values, block);
    const blocks::Texels got = blocks::decodeBc4(block);
    EXPECT_EQ(got[0][0], 0);
    EXPECT_EQ(got[1][0], 255);
    for (size_t i = 2; i < 16; ++i)
        EXPECT_NEAR(got[i][0], values[i], 13.0 / 5 / 2 + 1);
}

TEST(BlockEncode, FractionsCountBetweenTheEndpoints) // a 16-bit map's slope of less than a step
{
    Lanes values;
    for (size_t i = 0; i < 16; ++i)
        values.set(i, 127.0f + float(i) / 15);
    std::array<std::byte, 8> block{};
    encodeBc4(values, block);
    const float a = float(block[0]), b = float(block[1]);
    EXPECT_EQ(std::max(a, b), 128); // 8 places over one step, not two
    EXPECT_EQ(std::min(a, b), 127);
    uint64_t indices = 0;
    for (size_t i = 0; i < 6; ++i)
        indices |= uint64_t(block[2 + i]) << (8 * i);
    std::array<bool, 8> used{};
    for (size_t i = 0; i < 16; ++i)
        used[indices >> (3 * i) & 7] = true;
    EXPECT_EQ(std::count(used.begin(), used.end(), true), 8);
}
} // namespace
