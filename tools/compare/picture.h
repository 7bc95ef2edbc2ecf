// The picture that shows where two renderings differ.
#pragma once
#include "image/image.h"
#include "tools/compare/flip.h"
#include "tools/compare/welch.h"

#include <optional>

struct Picture
{
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> rgb; // [3 * width * height], sRGB
};

/// Exposed by `scale` and sRGB-encoded.
Picture exposedPicture(const ImageF& image, float scale);

/// Black (no error) over purple and orange to yellow (1).
Picture flipPicture(const FlipMap& flip, uint32_t width, uint32_t height);

/// Reference | test | difference, and the FLIP map where given, side by side. The first two are exposed by `scale` and
/// sRGB-encoded. Difference: (t - r) / (r + 1 % of the reference's mean) of the channel means; white where equal, red
/// where the test is brighter, blue where darker, full at 25 %. FLIP: as flipPicture().
Picture sideBySide(const ImageF& reference, const ImageF& test, float scale, const std::optional<FlipMap>& flip);

/// One pixel a tile: grey of the level p (even noise where only chance is at work) of the channel with the smallest;
/// where that is below the threshold, red where set a is brighter, blue where it is darker.
Picture pValueMap(const WelchResult& result);
