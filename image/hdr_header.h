// The text at the front of a Radiance picture.
#pragma once
#include "format/result.h"
#include "image/primaries.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

struct HdrHeader
{
    // A picture is stored as `line_count` lines of `line_pixels` pixels; the orientation gives their directions.
    uint32_t line_count = 0;
    uint32_t line_pixels = 0;
    bool columns = false;                  // a line is a column, from the top or the bottom
    bool bottom_up = false;                // +Y
    bool right_to_left = false;            // -X
    std::array<double, 3> factor{1, 1, 1}; // stored values times this are radiance: 1 / (EXPOSURE * COLORCORR)
    Matrix3 to_rec709 = kIdentity3;
    std::vector<std::string> notes; // as PictureInfo::notes
    size_t bytes = 0;               // of the header: where the lines begin
};

/// @return kInvalid if it is no header or has impossible values, kUnsupported for a size or format we do not read
Result<HdrHeader> parseHdrHeader(std::span<const std::byte> file);
