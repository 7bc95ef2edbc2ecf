#include "compiler/texture_pages.h"

#include "compiler/mip_chain.h"
#include "compiler/texture_tiles.h"
#include "format/material.h"
#include "format/texture_tile.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
TextureImage filled(uint32_t width, uint32_t height, bool srgb, uint8_t value)
{
    return {"test", width, height, srgb, std::vector<uint8_t>(size_t(4) * width * height, value)};
}

TexturePages rawPages(std::vector<TextureImage> images, const std::vector<TextureUse>& uses)
{
    return buildTexturePages(images, uses, {}, TextureCompression::kRaw);
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
    TextureImage image{"test", 2, 2, true, {0, 0, 0, 0, 255, 255, 255, 0, 255, 255, 255, 0, 0, 0, 0, 255}};
    const double half_light = 1.055 * std::pow(0.5, 1 / 2.4) - 0.055;
    std::array<float, 4> got = MipChain(image, {kAllChannels}).texel(1, 0, 0);
    EXPECT_EQ(got[0], std::lround(half_light * 255)); // 188
    EXPECT_NEAR(got[3], 63.75, 1e-3);                 // alpha is a number
    image.srgb = false;
    got = MipChain(image, {kAllChannels}).texel(1, 0, 0);
    EXPECT_NEAR(got[0], 127.5, 1e-3);
}

TEST(TexturePages, LevelsAreFilteredInMoreBitsThanTheyAreStored)
{
    TextureImage image{"test", 4, 4, false, std::vector<uint8_t>(64, 100)};
    image.texels[0] = 101; // one of sixteen: levels of bytes would round it away at once
    const MipChain chain(image, {kAllChannels});
    EXPECT_NEAR(chain.texel(2, 0, 0)[0], 100 + 1.0 / 16, 1e-4);
    image.deep.assign(64, 100 * 257);
    image.deep[0] += 32;
    EXPECT_NEAR(MipChain(image, {kAllChannels}).texel(1, 0, 0)[0], 100 + 8.0 / 257, 1e-4);
}

TEST(TexturePages, ColourCountsByTheAlphaThatCoversIt)
{
    const TextureImage image{"test", 2, 1, false, {200, 0, 0, 255, 0, 100, 0, 0}};
    EXPECT_NEAR(MipChain(image, {.channels = kAllChannels, .covers = true}).texel(1, 0, 0)[0], 200, 1e-3);
    EXPECT_NEAR(MipChain(image, {.channels = kAllChannels}).texel(1, 0, 0)[0], 100, 1e-3);
}

TEST(TexturePages, AsManyTexelsPassTheAlphaTestInEveryLevel)
{
    // Lines of alpha 255 between three of 0: their average, 64, would pass nowhere.
    TextureImage image = filled(64, 64, true, 0);
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 64; x += 4)
            image.texels[4 * (64 * y + x) + 3] = uint8_t(255 - 3 * (x / 4) - y / 16);
    const MipChain chain(image, {.channels = kAllChannels, .covers = true, .coverage_cutoff = 0.5f});
    for (uint32_t level = 0; level < 5; ++level)
    {
        uint32_t passing = 0;
        const uint32_t count = chain.width(level) * chain.height(level);
        for (uint32_t i = 0; i < count; ++i)
            passing +=
                std::round(chain.texel(level, i % chain.width(level), i / chain.width(level))[3]) >= 0.5f * 255 ? 1 : 0;
        EXPECT_NEAR(double(passing) / count, 0.25, level < 3 ? 1.0 / 32 : 1.0 / 8)
            << level; // equal texels pass together
    }
}

TEST(TexturePages, NormalsStayUnitVectorsInEveryLevel)
{
    const TextureImage image{"test", 2, 1, false, {218, 128, 218, 255, 38, 128, 218, 255}}; // 45 degrees each way
    const auto up = MipChain(image, {.channels = kAllChannels, .normal = true}).texel(1, 0, 0);
    EXPECT_NEAR(up[0], 127.5, 1);
    EXPECT_NEAR(up[2], 255, 0.01);
}

TEST(TexturePages, EveryConstantColourSurvivesAllMipLevels)
{
    for (int value = 0; value < 256; ++value)
    {
        const TexturePages pages = rawPages({filled(8, 8, true, uint8_t(value))}, {});
        for (const uint8_t texel : pages.pages[0].texels)
            ASSERT_EQ(texel, value);
    }
}

TEST(TexturePages, LayersLieSideBySideInEveryLevel)
{
    const TexturePages pages = rawPages({filled(4, 2, true, 10), filled(4, 2, false, 20), filled(4, 2, true, 30)},
                                        {TextureUse{2}, TextureUse{1}, TextureUse{0}});
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
    const TexturePages pages =
        rawPages({filled(5, 3, false, 7), filled(1, 4, false, 9)}, {TextureUse{0}, TextureUse{1}});
    EXPECT_EQ(pages.pages[pages.refs[0].page].levels, 3u); // 5x3, 2x1, 1x1
    EXPECT_EQ(pages.pages[pages.refs[0].page].texels.size(), 4u * (15 + 2 + 1));
    EXPECT_EQ(pages.pages[pages.refs[1].page].texels.size(), 4u * (4 + 2 + 1));
    for (const TexturePage& page : pages.pages)
        for (const uint8_t texel : page.texels)
            EXPECT_EQ(texel, page.width == 5 ? 7 : 9);
}

TEST(TexturePages, EqualImagesAreStoredOnce)
{
    const TexturePages pages = rawPages({filled(4, 4, true, 1), filled(4, 4, true, 2), filled(4, 4, true, 1)},
                                        {TextureUse{0}, TextureUse{1}, TextureUse{2}});
    ASSERT_EQ(pages.pages.size(), 1u);
    EXPECT_EQ(pages.pages[0].layers, 2u);
    EXPECT_EQ(pages.refs[0].layer, pages.refs[2].layer);
    EXPECT_NE(pages.refs[0].layer, pages.refs[1].layer);
}

TEST(TexturePages, MoreSizesThanPagesKeepThemInTiles)
{
    std::vector<TextureImage> images;
    std::vector<TextureUse> uses;
    for (uint32_t i = 0; i < 40; ++i)
    {
        images.push_back(filled(8 + i, 8, i % 2 == 0, uint8_t(5 * i)));
        uses.push_back(TextureUse{i});
    }
    const TexturePages pages = rawPages(images, uses);
    EXPECT_EQ(pages.pages.size(), gpu::kTexturePageCount);
    EXPECT_EQ(pages.halved, 0u);
    uint32_t tiles = 0;
    for (uint32_t i = 0; i < 40; ++i)
    {
        const gpu::TextureRef& ref = pages.refs[i];
        const TexturePage& page = pages.pages[ref.page];
        EXPECT_EQ(page.encoding,
                  i % 2 == 0 ? package::TextureEncoding::Rgba8Srgb : package::TextureEncoding::Rgba8Unorm);
        EXPECT_EQ(ref.size, (8 + i) | 8 << 16);
        EXPECT_EQ((ref.sampling & gpu::kSampleTile) != 0, page.tiled);
        if (!page.tiled)
            continue;
        ++tiles;
        for (uint32_t level = 0; level < 4; ++level) // with its border
        {
            const uint32_t x = gpu::tileLevelX(ref.origin & 0xffff, 8 + i, level),
                           y = gpu::tileLevelY(ref.origin >> 16, 8, level);
            for (uint32_t dy = 0; dy < gpu::levelSide(8, level) + 2; ++dy)
                for (uint32_t dx = 0; dx < gpu::levelSide(8 + i, level) + 2; ++dx)
                    ASSERT_EQ(page.texels[4 * ((size_t(ref.layer) * page.height + y + dy) * page.width + x + dx)],
                              5 * i);
        }
    }
    EXPECT_EQ(tiles, 40 - (gpu::kTexturePageCount - 2));
}

TEST(TexturePages, TilesDoNotOverlap)
{
    std::vector<TileSize> sizes;
    for (uint32_t i = 0; i < 200; ++i)
        sizes.push_back({1 + i * 37 % 90, 1 + i * 53 % 70});
    const TileLayout layout = layTiles(sizes);
    std::vector<bool> taken(size_t(layout.width) * layout.height * layout.layers);
    for (size_t i = 0; i < sizes.size(); ++i)
    {
        const TileSize extent = tileExtent(sizes[i]);
        const TilePlace& p = layout.places[i];
        ASSERT_TRUE(p.x % 4 == 0 && p.y % 4 == 0 && p.x + extent.width <= layout.width &&
                    p.y + extent.height <= layout.height);
        for (uint32_t y = p.y; y < p.y + extent.height; ++y)
            for (uint32_t x = p.x; x < p.x + extent.width; ++x)
            {
                const size_t at = (size_t(p.layer) * layout.height + y) * layout.width + x;
                ASSERT_FALSE(taken[at]) << i;
                taken[at] = true;
            }
    }
}

TEST(TexturePages, BlocksFitWhatMaterialsRead)
{
    gpu::Material m = package::defaultMaterial();
    m.normal_texture = 0;
    m.transmission_texture = 1;
    m.metallic_roughness_texture = 2;
    m.base_color_texture = 3;
    std::vector<TextureImage> images{filled(8, 8, false, 128), filled(8, 8, false, 60), filled(8, 8, false, 70),
                                     filled(6, 5, true, 80)};
    const std::vector<TextureUse> uses{TextureUse{0}, TextureUse{1}, TextureUse{2}, TextureUse{3}};
    const TexturePages pages = buildTexturePages(images, uses, std::span(&m, 1), TextureCompression::kBlocks);
    const auto encoding = [&](size_t use) { return pages.pages[pages.refs[use].page].encoding; };
    EXPECT_EQ(encoding(0), package::TextureEncoding::Bc5Unorm);
    EXPECT_NE(pages.refs[0].sampling & gpu::kSampleNormalXy, 0u);
    EXPECT_EQ(encoding(1), package::TextureEncoding::Bc4Unorm);
    EXPECT_EQ(encoding(2), package::TextureEncoding::Bc7Unorm);
    EXPECT_EQ(encoding(3), package::TextureEncoding::Bc7Srgb);
    EXPECT_EQ(pages.pages[pages.refs[3].page].texels.size(), 16u * (4 + 1 + 1)); // 6 x 5, 3 x 2, 1 x 1
}

TEST(TexturePages, NormalsThatLookIntoTheSurfaceKeepThreeChannels)
{
    gpu::Material m = package::defaultMaterial();
    m.normal_texture = 0;
    std::vector<TextureImage> images{filled(8, 8, false, 100)}; // z below 0
    const TexturePages pages =
        buildTexturePages(images, {TextureUse{0}}, std::span(&m, 1), TextureCompression::kBlocks);
    EXPECT_EQ(pages.pages[0].encoding, package::TextureEncoding::Bc7Unorm);
    EXPECT_EQ(pages.refs[0].sampling & gpu::kSampleNormalXy, 0u);
}
} // namespace
