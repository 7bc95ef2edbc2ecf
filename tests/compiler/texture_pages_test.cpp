#include "compiler/texture_pages.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
TextureImage filled(uint32_t width, uint32_t height, bool srgb, uint8_t value)
{
    return {"test", width, height, srgb, std::vector<uint8_t>(size_t(4) * width * height, value)};
}

/// Bytes of the levels before `level`, all layers.
size_t levelOffset(const TexturePage& page, uint32_t level)
{
    size_t bytes = 0;
    for (uint32_t i = 0; i < level; ++i)
        bytes += size_t(4) * std::max(page.width >> i, 1u) * std::max(page.height >> i, 1u) * page.layers;
    return bytes;
}

TEST(TexturePages, MipLevelsAverageLightForColourAndNumbersForData)
{
    // Two black and two white texels; alpha 0, 0, 0, 255.
    const std::vector<uint8_t> texels{0, 0, 0, 0, 255, 255, 255, 0, 255, 255, 255, 0, 0, 0, 0, 255};
    uint8_t got[4];
    halveImage(texels.data(), 2, 2, true, got);
    const double half_light = 1.055 * std::pow(0.5, 1 / 2.4) - 0.055;
    EXPECT_EQ(got[0], std::lround(half_light * 255)); // 188
    EXPECT_EQ(got[3], 64);                            // 63.75: alpha is a number
    halveImage(texels.data(), 2, 2, false, got);
    EXPECT_EQ(got[0], 128);
}

TEST(TexturePages, EveryConstantColourSurvivesAllMipLevels)
{
    for (int value = 0; value < 256; ++value)
    {
        std::vector<TextureImage> images{filled(8, 8, true, uint8_t(value))};
        const TexturePages pages = buildTexturePages(images, {});
        for (const uint8_t texel : pages.pages[0].texels)
            ASSERT_EQ(texel, value);
    }
}

TEST(TexturePages, LayersLieSideBySideInEveryLevel)
{
    std::vector<TextureImage> images{filled(4, 2, true, 10), filled(4, 2, false, 20), filled(4, 2, true, 30)};
    const TexturePages pages = buildTexturePages(images, {TextureUse{2}, TextureUse{1}, TextureUse{0}});
    ASSERT_EQ(pages.pages.size(), 2u);
    ASSERT_EQ(pages.refs.size(), 3u);
    for (const auto& [use, value] : {std::pair(0, 30), std::pair(1, 20), std::pair(2, 10)})
    {
        const gpu::TextureRef& ref = pages.refs[size_t(use)];
        const TexturePage& page = pages.pages[ref.page];
        EXPECT_EQ(page.levels, 3u); // 4x2, 2x1, 1x1
        EXPECT_EQ(page.texels.size(), levelOffset(page, 3));
        for (uint32_t level = 0; level < page.levels; ++level)
        {
            const size_t layer_bytes = size_t(4) * std::max(4u >> level, 1u) * std::max(2u >> level, 1u);
            EXPECT_EQ(page.texels[levelOffset(page, level) + layer_bytes * ref.layer], value);
            EXPECT_EQ(page.texels[levelOffset(page, level) + layer_bytes * (ref.layer + 1) - 1], value);
        }
    }
}

TEST(TexturePages, OddSizesHalveRoundingDown)
{
    std::vector<TextureImage> images{filled(5, 3, false, 7), filled(1, 4, false, 9)};
    const TexturePages pages = buildTexturePages(images, {TextureUse{0}, TextureUse{1}});
    EXPECT_EQ(pages.pages[pages.refs[0].page].levels, 3u); // 5x3, 2x1, 1x1
    EXPECT_EQ(pages.pages[pages.refs[0].page].texels.size(), 4u * (15 + 2 + 1));
    EXPECT_EQ(pages.pages[pages.refs[1].page].texels.size(), 4u * (4 + 2 + 1));
    for (const TexturePage& page : pages.pages)
        for (const uint8_t texel : page.texels)
            EXPECT_EQ(texel, page.width == 5 ? 7 : 9);
}

TEST(TexturePages, MoreSizesThanPagesAreResizedIntoLargerOnes)
{
    std::vector<TextureImage> images;
    std::vector<TextureUse> uses;
    for (uint32_t i = 0; i < 20; ++i)
    {
        images.push_back(filled(8 + i, 8, i % 2 == 0, uint8_t(10 * i)));
        uses.push_back(TextureUse{i});
    }
    const TexturePages pages = buildTexturePages(images, uses);
    EXPECT_EQ(pages.pages.size(), gpu::kTexturePageCount);
    EXPECT_EQ(pages.resized, 4u);
    for (uint32_t i = 0; i < 20; ++i)
    {
        const TexturePage& page = pages.pages[pages.refs[i].page];
        EXPECT_EQ(page.srgb, i % 2 == 0);
        EXPECT_GE(page.width, 8 + i);
        EXPECT_EQ(page.texels[size_t(4) * page.width * page.height * pages.refs[i].layer], 10 * i);
    }
}
} // namespace
