// The headers of an OpenEXR file, looked at before the library makes room for what they state.
#pragma once
#include "format/result.h"

#include <OpenEXR/ImfHeader.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Pixels min <= x < max, so that sizes do not overflow.
struct ExrWindow
{
    int64_t min_x, min_y, max_x, max_y;

    explicit ExrWindow(const Imath::Box2i& box)
        : min_x(box.min.x), min_y(box.min.y), max_x(int64_t(box.max.x) + 1), max_y(int64_t(box.max.y) + 1)
    {
    }
    int64_t width() const { return max_x - min_x; }
    int64_t height() const { return max_y - min_y; }
};

/// Rows that are read at once: a row of tiles, or whole blocks of lines.
int64_t exrStripRows(const Imf::Header& header);

/// @param name of the window, for the error. kInvalid where it is empty or out of reach, kUnsupported where it is too
/// large
Status checkExrWindow(const ExrWindow& window, const char* name);

/// The headers of all parts; their data windows are of sizes that we read and that the file can hold.
/// @return kInvalid, kUnsupported; throws what the library throws
Result<std::vector<Imf::Header>> readExrHeaders(std::span<const std::byte> file);
