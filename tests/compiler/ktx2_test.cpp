#include "compiler/ktx2.h"
#include "tests/compiler/ktx2_builder.h"

#include <gtest/gtest.h>
#include <zlib.h>
#include <zstd.h>

namespace
{
Result<Ktx2Image> decode(const std::vector<std::byte>& file)
{
    return decodeKtx2(file, [](uint32_t, uint32_t) -> Status { return Success{}; });
}

template <typename T>
std::vector<std::byte> bytesOf(const std::vector<T>& values)
{
    const auto bytes = std::as_bytes(std::span(values));
    return {bytes.begin(), bytes.end()};
}

std::vector<uint8_t> texelsOf(const Ktx2Header& header, const std::vector<std::byte>& level)
{
    const auto image = decode(makeKtx2(header, level));
    EXPECT_TRUE(image) << (image ? "" : image.error().message);
    return image ? image->texels : std::vector<uint8_t>();
}

TEST(Ktx2, BytesOfOneToFourChannelsInEitherOrder)
{
    using Texel = std::vector<uint8_t>;
    EXPECT_EQ(texelsOf({.vk_format = 9}, bytesOf(Texel{7})), (Texel{7, 0, 0, 255}));
    EXPECT_EQ(texelsOf({.vk_format = 16}, bytesOf(Texel{7, 8})), (Texel{7, 8, 0, 255}));
    EXPECT_EQ(texelsOf({.vk_format = 29}, bytesOf(Texel{7, 8, 9})), (Texel{7, 8, 9, 255}));
    EXPECT_EQ(texelsOf({.vk_format = 36}, bytesOf(Texel{7, 8, 9})), (Texel{9, 8, 7, 255}));
    EXPECT_EQ(texelsOf({.vk_format = 43}, bytesOf(Texel{7, 8, 9, 10})), (Texel{7, 8, 9, 10}));
    EXPECT_EQ(texelsOf({.vk_format = 50}, bytesOf(Texel{7, 8, 9, 10})), (Texel{9, 8, 7, 10}));
}

TEST(Ktx2, WordsAndFloatsKeepSixteenBitsAndAreClamped)
{
    const auto words =
        decode(makeKtx2({.vk_format = 91, .type_size = 2}, bytesOf(std::vector<uint16_t>{0x1234, 0, 0xffff, 0x8000})));
    ASSERT_TRUE(words);
    EXPECT_EQ(words->deep, (std::vector<uint16_t>{0x1234, 0, 0xffff, 0x8000}));
    EXPECT_FALSE(words->linear_light);
    const auto halfs =
        decode(makeKtx2({.vk_format = 97}, bytesOf(std::vector<uint16_t>{0x3800, 0xbc00, 0x7c00, 0x7e00})));
    ASSERT_TRUE(halfs); // 0.5, -1, infinite, not a number
    EXPECT_EQ(halfs->deep, (std::vector<uint16_t>{32768, 0, 65535, 0}));
    EXPECT_TRUE(halfs->linear_light);
    const auto floats = decode(makeKtx2({.vk_format = 103}, bytesOf(std::vector<float>{0.25f, 2})));
    ASSERT_TRUE(floats);
    EXPECT_EQ(floats->deep, (std::vector<uint16_t>{16384, 65535, 0, 65535}));
}

TEST(Ktx2, BlocksOfTwoColoursAndTheirAlpha)
{
    // Red (31, 0, 0) and blue (0, 0, 31): index 0, 1, 2, 3 in the first row, then 0.
    const std::vector<uint8_t> color{0x00, 0xf8, 0x1f, 0x00, 0xe4, 0, 0, 0};
    std::vector<uint8_t> got = texelsOf({.vk_format = 131, .width = 4, .height = 1}, bytesOf(color));
    EXPECT_EQ(got, (std::vector<uint8_t>{255, 0, 0, 255, 0, 0, 255, 255, 170, 0, 85, 255, 85, 0, 170, 255}));
    // The other way round there is one colour between them, and none.
    const std::vector<uint8_t> cut{0x1f, 0x00, 0x00, 0xf8, 0xe4, 0, 0, 0};
    got = texelsOf({.vk_format = 133, .width = 4, .height = 1}, bytesOf(cut));
    EXPECT_EQ(got, (std::vector<uint8_t>{0, 0, 255, 255, 255, 0, 0, 255, 128, 0, 128, 255, 0, 0, 0, 0}));
    std::vector<uint8_t> bc2{0x10, 0xf8, 0, 0, 0, 0, 0, 0};
    bc2.insert(bc2.end(), cut.begin(), cut.end()); // always four colours
    got = texelsOf({.vk_format = 135, .width = 4, .height = 1}, bytesOf(bc2));
    EXPECT_EQ(got, (std::vector<uint8_t>{0, 0, 255, 0, 255, 0, 0, 17, 85, 0, 170, 136, 170, 0, 85, 255}));
    std::vector<uint8_t> bc3{200, 10, 0x08, 0, 0, 0, 0, 0}; // alpha: index 0, 1, 0, 0
    bc3.insert(bc3.end(), color.begin(), color.end());
    got = texelsOf({.vk_format = 137, .width = 4, .height = 1}, bytesOf(bc3));
    EXPECT_EQ(got, (std::vector<uint8_t>{255, 0, 0, 200, 0, 0, 255, 10, 170, 0, 85, 200, 85, 0, 170, 200}));
}

TEST(Ktx2, SidesNeedNotBeWholeBlocks)
{
    std::vector<uint8_t> bc4(size_t(4) * 8, 0); // 2 x 2 blocks
    bc4[0] = 10, bc4[8] = 20, bc4[16] = 30, bc4[24] = 40;
    const std::vector<uint8_t> got = texelsOf({.vk_format = 139, .width = 5, .height = 6}, bytesOf(bc4));
    ASSERT_EQ(got.size(), 4u * 5 * 6);
    EXPECT_EQ(got[0], 10);
    EXPECT_EQ(got[4 * 4], 20);           // (4, 0)
    EXPECT_EQ(got[4 * (5 * 5)], 30);     // (0, 5)
    EXPECT_EQ(got[4 * (5 * 5 + 4)], 40); // (4, 5)
}

TEST(Ktx2, CompressedLevels)
{
    std::vector<std::byte> raw(4 * 16 * 16, std::byte{9});
    std::vector<std::byte> zstd(ZSTD_compressBound(raw.size()));
    zstd.resize(ZSTD_compress(zstd.data(), zstd.size(), raw.data(), raw.size(), 3));
    uLongf size = compressBound(uLong(raw.size()));
    std::vector<std::byte> zlib(size);
    compress(reinterpret_cast<Bytef*>(zlib.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
             uLong(raw.size()));
    zlib.resize(size);
    const std::vector<uint8_t> expected(raw.size(), 9);
    EXPECT_EQ(texelsOf({.width = 16, .height = 16, .supercompression = 2, .raw_bytes = raw.size()}, zstd), expected);
    EXPECT_EQ(texelsOf({.width = 16, .height = 16, .supercompression = 3, .raw_bytes = raw.size()}, zlib), expected);
    zstd[zstd.size() / 2] ^= std::byte{0xff};
    zlib[zlib.size() / 2] ^= std::byte{0xff};
    for (const auto& [scheme, bytes] : {std::pair(2u, zstd), std::pair(3u, zlib)})
    {
        const auto image =
            decode(makeKtx2({.width = 16, .height = 16, .supercompression = scheme, .raw_bytes = raw.size()}, bytes));
        ASSERT_FALSE(image) << scheme;
        EXPECT_EQ(image.error().code, ExitCode::kInvalid);
    }
}

TEST(Ktx2, WhatIsNotReadIsNamed)
{
    const std::vector<std::byte> level(16);
    const std::vector<std::pair<Ktx2Header, const char*>> cases{
        {{.width = 2, .height = 2, .depth = 1}, "volume"},
        {{.width = 2, .height = 2, .layers = 1}, "array"},
        {{.width = 2, .height = 2, .faces = 6}, "cube"},
        {{.width = 4, .height = 0}, "one-dimensional"},
        {{.vk_format = 0, .width = 4, .height = 4, .color_model = 166}, "UASTC"},
        {{.vk_format = 0, .width = 4, .height = 4, .supercompression = 1, .color_model = 163}, "ETC1S"},
        {{.vk_format = 143, .width = 4, .height = 4}, "VkFormat 143"},
        {{.width = 2, .height = 2, .supercompression = 4}, "scheme 4"}};
    for (const auto& [header, word] : cases)
    {
        const auto image = decode(makeKtx2(header, level));
        ASSERT_FALSE(image) << word;
        EXPECT_EQ(image.error().code, ExitCode::kUnsupported) << word;
        EXPECT_NE(image.error().message.find(word), std::string::npos) << image.error().message;
    }
}

TEST(Ktx2, DamagedFilesAreInvalid)
{
    const std::vector<std::byte> whole = makeKtx2({.width = 2, .height = 2}, std::vector<std::byte>(16));
    ASSERT_TRUE(decode(whole));
    for (size_t size = 12; size < whole.size(); size += 4)
        EXPECT_EQ(decode({whole.begin(), whole.begin() + ptrdiff_t(size)}).error().code, ExitCode::kInvalid) << size;
    for (const auto& [offset, value] : {std::pair(20, 0), std::pair(20, 3), std::pair(36, 2), std::pair(40, 99),
                                        std::pair(80, 145), std::pair(87, 255), std::pair(88, 15)})
    {
        std::vector<std::byte> damaged = whole; // width, faces, levels, the level's place and size
        damaged[size_t(offset)] = std::byte(value);
        const auto image = decode(damaged);
        ASSERT_FALSE(image) << offset;
        EXPECT_EQ(image.error().code, ExitCode::kInvalid) << offset;
    }
}
} // namespace
