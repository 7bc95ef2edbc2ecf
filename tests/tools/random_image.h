// Reproducible pictures for tests.
#pragma once
#include "image/image.h"

#include <random>

/// Values uniform in 0..`largest`.
inline ImageF randomImage(uint32_t width, uint32_t height, uint32_t seed, float largest = 1.0f)
{
    std::mt19937 random(seed);
    ImageF image{width, height, {}};
    for (size_t i = 0; i < 3 * image.pixelCount(); ++i)
        image.rgb.push_back(largest * float(random() >> 8) / 16777216.0f);
    return image;
}

inline ImageF constantImage(uint32_t width, uint32_t height, float r, float g, float b)
{
    ImageF image{width, height, {}};
    for (size_t i = 0; i < image.pixelCount(); ++i)
        image.rgb.insert(image.rgb.end(), {r, g, b});
    return image;
}
