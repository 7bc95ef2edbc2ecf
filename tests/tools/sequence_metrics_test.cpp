// Moving FLIP and flicker of sequences whose values are known.
#include "tools/bench/sequence_metrics.h"

#include "tests/tools/random_image.h"

#include <gtest/gtest.h>

namespace
{
constexpr uint32_t kWidth = 40, kHeight = 30, kPixels = kWidth * kHeight;
// Weights of a warp add up to 1 but for 1e-7, which is 1e-5 in lightness; FLIP raises that to the power 0.7 and divides
// by 17.
constexpr double kRounding = 1e-4;

/// A wall 2 m before a camera at (x, 0, 0), which fills the picture.
FirstHits wallSeenFrom(float x)
{
    FirstHits result{cameraParams({.position = {x, 0, 0}}, kWidth, kHeight), {}};
    for (const gpu::Ray& ray : centerRays(result.camera))
        result.hits.push_back(
            {ray.origin + (2 / -ray.direction.z) * ray.direction, {0, 0, 1}, 2 * pixelSide(result.camera), 0});
    return result;
}

/// So that the wall moves by that many pixels from one frame to the next.
float pixels(float count)
{
    return count * 2 * pixelSide(cameraParams({}, kWidth, kHeight));
}

SequenceFrame frameOf(ImageF picture, ImageF reference, float x)
{
    return {std::move(picture), std::move(reference), wallSeenFrom(x), std::vector<uint8_t>(kPixels, 1)};
}

ImageF grey(float value)
{
    return constantImage(kWidth, kHeight, value, value, value);
}

/// `image` as seen by a camera `shift` pixels to the right; new columns are black.
ImageF shifted(const ImageF& image, uint32_t shift)
{
    ImageF result = constantImage(image.width, image.height, 0, 0, 0);
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x + shift < image.width; ++x)
            for (uint32_t channel = 0; channel < 3; ++channel)
                result.rgb[3 * (y * image.width + x) + channel] =
                    image.rgb[3 * (y * image.width + x + shift) + channel];
    return result;
}
} // namespace

TEST(SequenceMetricsTest, PicturesAsTheirReferencesHaveNoErrorAndNoFlickerOfTheirOwn)
{
    SequenceMetrics metrics;
    for (uint32_t frame = 0; frame < 5; ++frame)
    {
        const ImageF noise = randomImage(kWidth, kHeight, frame);
        EXPECT_EQ(metrics.add(frameOf(noise, noise, pixels(0.4f * float(frame)))).mean, 0);
    }
    EXPECT_EQ(metrics.meanFlip(), 0);
    EXPECT_EQ(metrics.flip().size(), 5u);
    for (size_t distance = 1; distance <= 3; ++distance)
    {
        EXPECT_EQ(metrics.flicker(distance).value(), 0);
        EXPECT_GT(metrics.flicker(distance).references.value(), 0.1) << "noise of other seeds flickers";
    }
}

TEST(SequenceMetricsTest, WhatMovesWithItsSurfaceDoesNotFlicker)
{
    const ImageF texture = randomImage(kWidth, kHeight, 7);
    SequenceMetrics metrics;
    for (uint32_t frame = 0; frame < 4; ++frame)
        metrics.add(frameOf(shifted(texture, frame), grey(0.5f), pixels(float(frame))));
    EXPECT_GT(metrics.meanFlip(), 0.1);
    for (size_t distance = 1; distance <= 3; ++distance)
    {
        // By whole pixels, places are off by rounding alone, 1e-5 pixels of a texture that changes by 1 in one; FLIP
        // raises differences to the power 0.7.
        EXPECT_NEAR(metrics.flicker(distance).pictures.value(), 0, 2e-3);
        EXPECT_NEAR(metrics.flicker(distance).references.value(), 0, kRounding);
        // The columns that came into view are left out.
        EXPECT_EQ(metrics.flicker(distance).pictures.count, (4 - distance) * (kWidth - distance) * kHeight);
    }
    EXPECT_EQ(metrics.unseenFlip().count, 3 * kHeight);
    EXPECT_NEAR(metrics.unseenShare(), 1.0 / kWidth, 1e-9);
}

TEST(SequenceMetricsTest, FlickerIsTheFlipBetweenFramesThatAlternate)
{
    SequenceMetrics metrics;
    for (uint32_t frame = 0; frame < 6; ++frame)
        metrics.add(frameOf(grey(frame % 2 ? 0.6f : 0.4f), grey(0.5f), 0));
    const double flip = ldrFlip(grey(0.4f), grey(0.6f)).mean;
    EXPECT_GT(flip, 0.05);
    EXPECT_NEAR(metrics.flicker(1).value(), flip, kRounding);
    EXPECT_NEAR(metrics.flicker(2).value(), 0, kRounding);
    EXPECT_NEAR(metrics.flicker(3).value(), flip, kRounding);
    EXPECT_EQ(metrics.unseenFlip().count, 0u);
    const double expected = (ldrFlip(grey(0.5f), grey(0.6f)).mean + ldrFlip(grey(0.5f), grey(0.4f)).mean) / 2;
    EXPECT_NEAR(metrics.meanFlip(), expected, 1e-9);
}

TEST(SequenceMetricsTest, PlainPixelsAreCountedApart)
{
    SequenceMetrics metrics;
    for (uint32_t frame = 0; frame < 2; ++frame)
    {
        ImageF picture = grey(0.5f);
        for (uint32_t i = 0; i < 3 * kPixels / 2; ++i) // the upper half flickers
            picture.rgb[i] = frame ? 0.9f : 0.1f;
        SequenceFrame next = frameOf(picture, grey(0.5f), 0);
        // Plain is only what lies farther below than FLIP's filters reach.
        for (uint32_t i = 0; i < kPixels; ++i)
            next.plain[i] = i / kWidth >= kHeight / 2 + 12;
        metrics.add(std::move(next));
    }
    EXPECT_GT(metrics.flicker(1).value(), 0.1);
    EXPECT_NEAR(metrics.plainFlicker(1).value(), 0, kRounding);
    EXPECT_EQ(metrics.plainFlicker(1).pictures.count, 3u * kWidth);
}

TEST(SequenceMetricsTest, PixelsNearACausticAreNotPlain)
{
    ImageF caustics = grey(0);
    const uint32_t spot_x = 1, spot_y = 20;
    // One channel of one pixel in a block of at most 7 x 7 with 0.5 in each channel: 0.9 of at most 73.5, more than a
    // hundredth.
    caustics.rgb[3 * (spot_y * kWidth + spot_x)] = 0.9f;
    std::vector<uint8_t> plain(kPixels, 1);
    plain[0] = 0;
    excludeCaustics(plain, grey(0.5f), caustics);
    for (uint32_t i = 0; i < kPixels; ++i)
    {
        const uint32_t x = i % kWidth, y = i / kWidth;
        const bool near = x <= spot_x + 3 && y + 3 >= spot_y && y <= spot_y + 3;
        EXPECT_EQ(plain[i] != 0, !near && i != 0) << x << ", " << y;
    }
    excludeCaustics(plain, grey(0.5f), grey(0.004f)); // less than a hundredth
    EXPECT_NE(plain[5], 0);
}
