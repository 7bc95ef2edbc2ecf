// Lays small pictures out in rows, each with a number.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

struct Thumbnail
{
    std::string label; // digits are drawn, the rest is not
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> rgb; // [3 * width * height] sRGB
};

/// Cells are as large as the largest thumbnail and a label of kLabelHeight above it; what is left over is dark grey.
/// @return a picture of `columns` cells a row (fewer where there are fewer thumbnails), without label; empty for none
Thumbnail contactSheet(const std::vector<Thumbnail>& thumbnails, uint32_t columns);

inline constexpr uint32_t kLabelHeight = 14; // pixels: digits of 6 x 10 and what is around them
