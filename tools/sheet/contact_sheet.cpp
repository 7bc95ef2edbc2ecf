#include "tools/sheet/contact_sheet.h"

#include <algorithm>
#include <cstddef>

namespace
{
constexpr uint8_t kGround = 32;
constexpr uint32_t kMargin = 2; // pixels around a cell

/// 3 x 5 pixels a digit, a row three bits, the left one highest.
constexpr uint8_t kDigits[10][5] = {{7, 5, 5, 5, 7}, {2, 6, 2, 2, 7}, {7, 1, 7, 4, 7}, {7, 1, 3, 1, 7},
                                    {5, 5, 7, 1, 1}, {7, 4, 7, 1, 7}, {7, 4, 7, 5, 7}, {7, 1, 1, 2, 2},
                                    {7, 5, 7, 5, 7}, {7, 5, 7, 1, 7}};

void drawLabel(const std::string& label, uint32_t x, uint32_t y, uint32_t most_width, Thumbnail& sheet)
{
    constexpr uint32_t kScale = 2;
    const uint32_t end = x + most_width;
    for (const char c : label)
    {
        if (c < '0' || c > '9')
            continue;
        if (x + 3 * kScale > end)
            return;
        for (uint32_t row = 0; row < 5 * kScale; ++row)
            for (uint32_t column = 0; column < 3 * kScale; ++column)
                if ((kDigits[c - '0'][row / kScale] >> (2 - column / kScale) & 1) != 0)
                    std::fill_n(sheet.rgb.begin() + 3 * std::ptrdiff_t((y + row) * size_t(sheet.width) + x + column), 3,
                                uint8_t(255));
        x += 4 * kScale;
    }
}
} // namespace

Thumbnail contactSheet(const std::vector<Thumbnail>& thumbnails, uint32_t columns)
{
    Thumbnail sheet;
    if (thumbnails.empty())
        return sheet;
    uint32_t width = 0;
    uint32_t height = 0;
    for (const Thumbnail& thumbnail : thumbnails)
    {
        width = std::max(width, thumbnail.width);
        height = std::max(height, thumbnail.height);
    }
    const auto count = uint32_t(thumbnails.size());
    columns = std::clamp(columns, 1u, count);
    const uint32_t cell_width = width + 2 * kMargin;
    const uint32_t cell_height = height + 2 * kMargin + kLabelHeight;
    sheet.width = columns * cell_width;
    sheet.height = (count + columns - 1) / columns * cell_height;
    sheet.rgb.assign(size_t(3) * sheet.width * sheet.height, kGround);
    for (uint32_t i = 0; i < count; ++i)
    {
        const Thumbnail& from = thumbnails[i];
        const uint32_t x = i % columns * cell_width + kMargin;
        const uint32_t y = i / columns * cell_height + kMargin;
        drawLabel(from.label, x, y + 2, width, sheet);
        for (uint32_t row = 0; row < from.height; ++row)
            std::copy_n(from.rgb.begin() + 3 * std::ptrdiff_t(row * size_t(from.width)), size_t(3) * from.width,
                        sheet.rgb.begin() + 3 * std::ptrdiff_t((y + kLabelHeight + row) * size_t(sheet.width) + x));
    }
    return sheet;
}
