#include "compiler/ktx2_texels.h"

#include "compiler/encode.h"
#include "format/block_texture.h"
#include "format/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace
{
uint32_t channelBytes(Ktx2Kind kind)
{
    return kind == Ktx2Kind::kUnorm8 ? 1 : kind == Ktx2Kind::kFloat32 ? 4 : 2;
}

bool isBlocks(Ktx2Kind kind)
{
    return kind >= Ktx2Kind::kBc1;
}

uint32_t blockBytes(Ktx2Kind kind)
{
    return kind == Ktx2Kind::kBc1 || kind == Ktx2Kind::kBc4 ? 8 : 16;
}

template <typename T>
T load(const std::byte* from)
{
    T value;
    std::memcpy(&value, from, sizeof(T));
    return value;
}

uint16_t wordOf(float value) // not a number: 0
{
    return value > 0 ? uint16_t(std::lround(std::min(value, 1.0f) * 65535)) : uint16_t(0);
}

uint16_t readWord(Ktx2Kind kind, const std::byte* from)
{
    if (kind == Ktx2Kind::kFloat32)
        return wordOf(load<float>(from));
    const auto word = load<uint16_t>(from);
    if (kind == Ktx2Kind::kUnorm16)
        return word;
    const bool special = (word & 0x7c00) == 0x7c00; // infinite or not a number
    return special ? uint16_t(word == 0x7c00 ? 65535 : 0) : wordOf(decodeHalf(word));
}

void decodeTexels(const Ktx2Format& format, const std::byte* from, Ktx2Image& image)
{
    const size_t count = size_t(image.width) * image.height;
    const uint32_t bytes = channelBytes(format.kind);
    if (format.kind != Ktx2Kind::kUnorm8)
        image.deep.resize(4 * count);
    for (size_t i = 0; i < count; ++i)
        for (uint32_t c = 0; c < 4; ++c)
        {
            const uint32_t source = format.bgr && c < 3 ? 2 - c : c;
            const bool there = source < format.channels;
            const std::byte* at = from + (i * format.channels + source) * bytes;
            if (format.kind == Ktx2Kind::kUnorm8)
            {
                image.texels[4 * i + c] = there ? uint8_t(*at) : uint8_t(c == 3 ? 255 : 0);
                continue;
            }
            const uint16_t word = there ? readWord(format.kind, at) : uint16_t(c == 3 ? 65535 : 0);
            image.deep[4 * i + c] = word;
            image.texels[4 * i + c] = uint8_t((word + 128u) / 257);
        }
}

/// Two colours of 5, 6 and 5 bits and what lies between them. @param four_colors whatever their order (BC2, BC3)
blocks::Texels decodeColors(const std::byte* block, bool four_colors)
{
    const auto a = load<uint16_t>(block), b = load<uint16_t>(block + 2);
    const auto indices = load<uint32_t>(block + 4);
    const auto expand = [](uint16_t c)
    {
        const uint32_t r = c >> 11, g = c >> 5 & 63, b5 = c & 31;
        return std::array<uint32_t, 4>{r << 3 | r >> 2, g << 2 | g >> 4, b5 << 3 | b5 >> 2, 255};
    };
    std::array<std::array<uint32_t, 4>, 4> palette{expand(a), expand(b)};
    const bool thirds = four_colors || a > b;
    palette[3] = {0, 0, 0, 0};
    for (size_t c = 0; c < 3; ++c)
    {
        palette[2][c] = thirds ? (2 * palette[0][c] + palette[1][c] + 1) / 3 : (palette[0][c] + palette[1][c] + 1) / 2;
        if (thirds)
            palette[3][c] = (palette[0][c] + 2 * palette[1][c] + 1) / 3;
    }
    palette[2][3] = 255;
    palette[3][3] = thirds ? 255 : 0;
    blocks::Texels texels;
    for (size_t i = 0; i < 16; ++i)
        for (size_t c = 0; c < 4; ++c)
            texels[i][c] = uint8_t(palette[indices >> (2 * i) & 3][c]);
    return texels;
}

/// BC5 holds normals: blue is what makes them unit vectors.
void completeNormals(blocks::Texels& texels)
{
    for (auto& t : texels)
    {
        const float x = float(t[0]) / 127.5f - 1, y = float(t[1]) / 127.5f - 1;
        t[2] = uint8_t(std::lround((std::sqrt(std::max(0.0f, 1 - x * x - y * y)) + 1) * 127.5f));
    }
}

blocks::Texels decodeBlock(const Ktx2Format& format, const std::byte* block)
{
    const std::span<const std::byte, 8> half(block, 8);
    blocks::Texels texels;
    switch (format.kind)
    {
    case Ktx2Kind::kBc1:
        texels = decodeColors(block, false);
        if (!format.alpha)
            for (auto& t : texels)
                t[3] = 255;
        return texels;
    case Ktx2Kind::kBc2:
        texels = decodeColors(block + 8, true);
        for (size_t i = 0; i < 16; ++i)
            texels[i][3] = uint8_t((uint32_t(block[i / 2]) >> (4 * (i % 2)) & 15) * 17);
        return texels;
    case Ktx2Kind::kBc3:
    {
        texels = decodeColors(block + 8, true);
        const blocks::Texels alpha = blocks::decodeBc4(half);
        for (size_t i = 0; i < 16; ++i)
            texels[i][3] = alpha[i][0];
        return texels;
    }
    case Ktx2Kind::kBc4:
        return blocks::decodeBc4(half);
    case Ktx2Kind::kBc5:
        texels = blocks::decodeBc5(std::span<const std::byte, 16>(block, 16));
        completeNormals(texels);
        return texels;
    default:
        return blocks::decodeBc7(std::span<const std::byte, 16>(block, 16));
    }
}
} // namespace

std::optional<Ktx2Format> ktx2Format(uint32_t vk_format)
{
    struct Entry
    {
        uint32_t unorm, other; // VkFormat, and of the sRGB or floating-point sibling
        Ktx2Format format;
    };
    static constexpr std::array kEntries{Entry{9, 15, {Ktx2Kind::kUnorm8, 1}},
                                         Entry{16, 22, {Ktx2Kind::kUnorm8, 2}},
                                         Entry{23, 29, {Ktx2Kind::kUnorm8, 3}},
                                         Entry{30, 36, {Ktx2Kind::kUnorm8, 3, true}},
                                         Entry{37, 43, {Ktx2Kind::kUnorm8, 4}},
                                         Entry{44, 50, {Ktx2Kind::kUnorm8, 4, true}},
                                         Entry{70, 70, {Ktx2Kind::kUnorm16, 1}},
                                         Entry{77, 77, {Ktx2Kind::kUnorm16, 2}},
                                         Entry{84, 84, {Ktx2Kind::kUnorm16, 3}},
                                         Entry{91, 91, {Ktx2Kind::kUnorm16, 4}},
                                         Entry{76, 76, {Ktx2Kind::kFloat16, 1}},
                                         Entry{83, 83, {Ktx2Kind::kFloat16, 2}},
                                         Entry{90, 90, {Ktx2Kind::kFloat16, 3}},
                                         Entry{97, 97, {Ktx2Kind::kFloat16, 4}},
                                         Entry{100, 100, {Ktx2Kind::kFloat32, 1}},
                                         Entry{103, 103, {Ktx2Kind::kFloat32, 2}},
                                         Entry{106, 106, {Ktx2Kind::kFloat32, 3}},
                                         Entry{109, 109, {Ktx2Kind::kFloat32, 4}},
                                         Entry{131, 132, {Ktx2Kind::kBc1, 4, false, false}},
                                         Entry{133, 134, {Ktx2Kind::kBc1}},
                                         Entry{135, 136, {Ktx2Kind::kBc2}},
                                         Entry{137, 138, {Ktx2Kind::kBc3}},
                                         Entry{139, 139, {Ktx2Kind::kBc4}},
                                         Entry{141, 141, {Ktx2Kind::kBc5}},
                                         Entry{145, 146, {Ktx2Kind::kBc7}}};
    for (const Entry& entry : kEntries)
        if (vk_format == entry.unorm || vk_format == entry.other)
            return entry.format;
    return std::nullopt;
}

uint64_t ktx2LevelBytes(const Ktx2Format& format, uint32_t width, uint32_t height)
{
    if (isBlocks(format.kind))
        return blocks::countIn(width, height) * blockBytes(format.kind);
    return uint64_t(width) * height * format.channels * channelBytes(format.kind);
}

void decodeKtx2Level(const Ktx2Format& format, std::span<const std::byte> bytes, Ktx2Image& image)
{
    check(bytes.size() == ktx2LevelBytes(format, image.width, image.height), "{} bytes", bytes.size());
    image.texels.resize(size_t(4) * image.width * image.height);
    image.linear_light = format.kind == Ktx2Kind::kFloat16 || format.kind == Ktx2Kind::kFloat32;
    if (!isBlocks(format.kind))
        return decodeTexels(format, bytes.data(), image);
    const std::byte* block = bytes.data();
    for (uint32_t y = 0; y < image.height; y += blocks::kSide)
        for (uint32_t x = 0; x < image.width; x += blocks::kSide, block += blockBytes(format.kind))
        {
            const blocks::Texels texels = decodeBlock(format, block);
            const uint32_t columns = std::min(blocks::kSide, image.width - x);
            for (uint32_t row = 0; row < std::min(blocks::kSide, image.height - y); ++row)
                std::memcpy(image.texels.data() + 4 * ((size_t(y) + row) * image.width + x),
                            &texels[blocks::kSide * row], size_t(4) * columns);
        }
}
