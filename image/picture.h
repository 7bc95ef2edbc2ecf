// The output of picture readers, line by line, so that a caller need not store whole pictures.
#pragma once
#include "format/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

inline constexpr int64_t kMaxPictureSide = 65536;              // pixels
inline constexpr int64_t kMaxPicturePixels = int64_t(1) << 29; // 32768 x 16384

struct PictureInfo
{
    uint32_t width = 0; // pixels, 1 to kMaxPictureSide
    uint32_t height = 0;
    bool cube = false;              // six square faces one below the other: +X, -X, +Y, -Y, +Z, -Z
    std::vector<std::string> notes; // what was chosen or converted that a user may not expect, full sentences
};

/// Pixels that follow each other along a row or a column.
struct ScanLine
{
    uint32_t x = 0; // of the first pixel; row 0 on top
    uint32_t y = 0;
    int step_x = 1; // from one pixel to the next: (1, 0), (-1, 0), (0, 1) or (0, -1)
    int step_y = 0;
    std::span<const float> rgb; // [3 * pixels] linear Rec. 709
};

/// Calls visit(x, y, rgb) for every pixel of `line`.
template <typename Visit>
void forEachPixel(const ScanLine& line, const Visit& visit)
{
    uint32_t x = line.x, y = line.y;
    for (size_t i = 0; i < line.rgb.size(); i += 3, x += uint32_t(line.step_x), y += uint32_t(line.step_y))
        visit(x, y, line.rgb.data() + i);
}

/// Receives a picture. Each pixel comes at most once; missing pixels are black.
class PictureSink
{
public:
    virtual ~PictureSink() = default;
    /// Called once, before any pixel. An error ends the reading.
    virtual Status begin(const PictureInfo& info) = 0;
    virtual void add(const ScanLine& line) = 0;
};
