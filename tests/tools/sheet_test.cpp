#include "tools/sheet/contact_sheet.h"

#include <gtest/gtest.h>

namespace
{
Thumbnail plain(const char* label, uint32_t width, uint32_t height, uint8_t value)
{
    return {label, width, height, std::vector<uint8_t>(size_t(3) * width * height, value)};
}

uint8_t at(const Thumbnail& sheet, uint32_t x, uint32_t y)
{
    return sheet.rgb[3 * (size_t(y) * sheet.width + x)];
}

TEST(ContactSheet, OfNothingIsEmpty)
{
    EXPECT_EQ(contactSheet({}, 4).width, 0u);
}

TEST(ContactSheet, PutsPicturesIntoCellsOfTheLargestInRows)
{
    const Thumbnail sheet = contactSheet({plain("1", 20, 10, 100), plain("2", 8, 10, 110), plain("3", 20, 4, 120)}, 2);
    const uint32_t cell_width = 24, cell_height = 14 + kLabelHeight;
    ASSERT_EQ(sheet.width, 2 * cell_width);
    ASSERT_EQ(sheet.height, 2 * cell_height);
    EXPECT_EQ(at(sheet, 2, 2 + kLabelHeight), 100);
    EXPECT_EQ(at(sheet, 21, 11 + kLabelHeight), 100);
    EXPECT_EQ(at(sheet, 22, 11 + kLabelHeight), 32); // the margin
    EXPECT_EQ(at(sheet, cell_width + 2, 2 + kLabelHeight), 110);
    EXPECT_EQ(at(sheet, cell_width + 10, 2 + kLabelHeight), 32); // smaller than its cell
    EXPECT_EQ(at(sheet, 2, cell_height + 2 + kLabelHeight), 120);
}

TEST(ContactSheet, DrawsTheDigitsOfALabelAsFarAsTheyFit)
{
    const auto whites = [](const char* label, uint32_t width)
    {
        const Thumbnail sheet = contactSheet({plain(label, width, 4, 0)}, 1);
        uint32_t count = 0;
        for (uint32_t y = 0; y < 2 + kLabelHeight; ++y)
            for (uint32_t x = 0; x < sheet.width; ++x)
                count += at(sheet, x, y) == 255;
        return count;
    };
    EXPECT_EQ(whites("8", 30), 4u * 13);      // 13 of 15 pixels, twice as large
    EXPECT_EQ(whites("a1b", 30), 4u * 8);     // digits alone
    EXPECT_EQ(whites("88", 30), 2u * 4 * 13); // 14 pixels wide
    EXPECT_EQ(whites("88", 13), 4u * 13);
}
} // namespace
