#include "tools/compare/picture.h"

#include "image/write_image.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace
{

constexpr uint32_t kGap = 4; // grey columns between panels
constexpr float kFullDifference = 0.25f;

using Bytes = std::array<uint8_t, 3>;

float grey(const ImageF& image, size_t pixel)
{
    return (image.rgb[3 * pixel] + image.rgb[3 * pixel + 1] + image.rgb[3 * pixel + 2]) / 3.0f;
}

Bytes exposed(const ImageF& image, size_t pixel, float scale)
{
    const float* rgb = &image.rgb[3 * pixel];
    return {srgbByte(rgb[0] * scale), srgbByte(rgb[1] * scale), srgbByte(rgb[2] * scale)};
}

Bytes difference(float reference, float test, float floor)
{
    const float relative = (test - reference) / (std::max(reference, 0.0f) + floor) / kFullDifference;
    const float v = std::clamp(relative, -1.0f, 1.0f);
    const auto byte = [](float x) { return uint8_t(255.0f * x + 0.5f); };
    return {byte(1.0f + std::min(v, 0.0f)), byte(1.0f - std::abs(v)), byte(1.0f - std::max(v, 0.0f))};
}

/// Dark to bright through purple and orange, even in lightness; straight lines between nine stops.
Bytes flipColor(float error)
{
    static constexpr float kStops[9][3] = {{0, 0, 4},      {28, 16, 68},    {79, 18, 123},
                                           {129, 37, 129}, {181, 54, 122},  {229, 80, 100},
                                           {251, 135, 97}, {254, 194, 135}, {252, 253, 191}};
    const float position = std::clamp(error, 0.0f, 1.0f) * 8.0f;
    const int stop = std::min(int(position), 7);
    const float t = position - float(stop);
    Bytes color;
    for (size_t i = 0; i < 3; ++i)
        color[i] = uint8_t(kStops[stop][i] * (1.0f - t) + kStops[stop + 1][i] * t + 0.5f);
    return color;
}

} // namespace

Picture exposedPicture(const ImageF& image, float scale)
{
    Picture picture{image.width, image.height, {}};
    picture.rgb.reserve(image.rgb.size());
    for (const float value : image.rgb)
        picture.rgb.push_back(srgbByte(value * scale));
    return picture;
}

Picture flipPicture(const FlipMap& flip, uint32_t width, uint32_t height)
{
    Picture picture{width, height, {}};
    picture.rgb.reserve(3 * flip.error.size());
    for (const float error : flip.error)
    {
        const Bytes color = flipColor(error);
        picture.rgb.insert(picture.rgb.end(), color.begin(), color.end());
    }
    return picture;
}

Picture sideBySide(const ImageF& reference, const ImageF& test, float scale, const std::optional<FlipMap>& flip)
{
    const uint32_t panel_count = flip ? 4 : 3;
    Picture picture{panel_count * (reference.width + kGap) - kGap, reference.height, {}};
    picture.rgb.assign(3 * size_t(picture.width) * picture.height, 128);

    double mean = 0;
    for (size_t i = 0; i < reference.pixelCount(); ++i)
        mean += double(grey(reference, i)) / double(reference.pixelCount());
    const float floor = std::max(0.01f * float(mean), 1e-9f);

    for (uint32_t y = 0; y < reference.height; ++y)
    {
        for (uint32_t x = 0; x < reference.width; ++x)
        {
            const size_t i = size_t(y) * reference.width + x;
            const auto put = [&](uint32_t panel, const Bytes& color)
            {
                const size_t column = size_t(panel) * (reference.width + kGap) + x;
                std::copy(color.begin(), color.end(), &picture.rgb[3 * (size_t(y) * picture.width + column)]);
            };
            put(0, exposed(reference, i, scale));
            put(1, exposed(test, i, scale));
            put(2, difference(grey(reference, i), grey(test, i), floor));
            if (flip)
                put(3, flipColor(flip->error[i]));
        }
    }
    return picture;
}

Picture pValueMap(const WelchResult& result)
{
    Picture picture{result.columns, result.rows, {}};
    for (uint32_t tile = 0; tile < result.columns * result.rows; ++tile)
    {
        const auto first = result.tests.begin() + std::ptrdiff_t(3 * tile);
        const WelchTest& least =
            *std::min_element(first, first + 3, [](const auto& x, const auto& y) { return x.p < y.p; });
        const uint8_t level = uint8_t(255.0 * least.p + 0.5);
        Bytes color{level, level, level};
        if (least.p < result.threshold)
            color = least.difference > 0 ? Bytes{255, 0, 0} : Bytes{0, 0, 255};
        picture.rgb.insert(picture.rgb.end(), color.begin(), color.end());
    }
    return picture;
}
