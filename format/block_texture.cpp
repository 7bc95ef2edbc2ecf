#include "format/block_texture.h"

#include "format/bc7_tables.h"
#include "format/block_bits.h"

#include <bit>
#include <utility>

namespace blocks
{
namespace
{
/// One channel of BC4: two endpoints and sixteen 3-bit indices.
std::array<uint8_t, 16> decodeChannel(std::span<const std::byte, 8> block)
{
    const auto a = uint32_t(block[0]);
    const auto b = uint32_t(block[1]);
    std::array<uint8_t, 8> palette{uint8_t(a), uint8_t(b)};
    const uint32_t steps = a > b ? 7 : 5;
    for (uint32_t i = 1; i < steps; ++i)
        palette[i + 1] = uint8_t((2 * ((steps - i) * a + i * b) + steps) / (2 * steps)); // to nearest
    if (steps == 5)
        palette[6] = 0, palette[7] = 255;
    uint64_t indices = 0;
    for (size_t i = 0; i < 6; ++i)
        indices |= uint64_t(block[2 + i]) << (8 * i);
    std::array<uint8_t, 16> values;
    for (size_t i = 0; i < 16; ++i)
        values[i] = palette[indices >> (3 * i) & 7];
    return values;
}

struct Bc7Mode
{
    uint32_t subsets, partition_bits, rotation_bits, selection_bits;
    uint32_t color_bits, alpha_bits;         // of an endpoint
    uint32_t endpoint_p_bits, shared_p_bits; // 1: an extra lowest bit an endpoint, or a subset
    uint32_t index_bits, second_index_bits;
};
constexpr std::array<Bc7Mode, 8> kBc7Modes{{{3, 4, 0, 0, 4, 0, 1, 0, 3, 0},
                                            {2, 6, 0, 0, 6, 0, 0, 1, 3, 0},
                                            {3, 6, 0, 0, 5, 0, 0, 0, 2, 0},
                                            {2, 6, 0, 0, 7, 0, 1, 0, 2, 0},
                                            {1, 0, 2, 1, 5, 6, 0, 0, 2, 3},
                                            {1, 0, 2, 0, 7, 8, 0, 0, 2, 2},
                                            {1, 0, 0, 0, 7, 7, 1, 0, 4, 0},
                                            {2, 6, 0, 0, 5, 5, 1, 0, 2, 0}}};

uint32_t subsetOf(const Bc7Mode& mode, uint32_t partition, uint32_t texel)
{
    return mode.subsets == 1   ? 0
           : mode.subsets == 2 ? bc7::kTwoSubsets[partition] >> texel & 1
                               : bc7::kThreeSubsets[partition] >> (2 * texel) & 3;
}

bool isAnchor(const Bc7Mode& mode, uint32_t partition, uint32_t texel)
{
    return texel == 0 || (mode.subsets == 2 && texel == bc7::kAnchorOfTwo[partition]) ||
           (mode.subsets == 3 &&
            (texel == bc7::kFirstAnchorOfThree[partition] || texel == bc7::kSecondAnchorOfThree[partition]));
}

using Endpoints = std::array<std::array<uint32_t, 4>, 6>; // two a subset, RGBA, 8 bits each

Endpoints readEndpoints(const Bc7Mode& mode, BitReader& bits)
{
    Endpoints ends{};
    const uint32_t count = 2 * mode.subsets;
    for (uint32_t c = 0; c < (mode.alpha_bits > 0 ? 4u : 3u); ++c)
        for (uint32_t i = 0; i < count; ++i)
            ends[i][c] = bits.take(c < 3 ? mode.color_bits : mode.alpha_bits);
    const uint32_t p_bits = mode.endpoint_p_bits + mode.shared_p_bits;
    uint32_t p = 0;
    for (uint32_t i = 0; i < count && p_bits > 0; ++i)
    {
        if (mode.endpoint_p_bits == 1 || i % 2 == 0)
            p = bits.take(1);
        for (uint32_t& value : ends[i])
            value = value << 1 | p;
    }
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t c = 0; c < 4; ++c)
        {
            const uint32_t width = (c < 3 ? mode.color_bits : mode.alpha_bits) + p_bits;
            const uint32_t value = ends[i][c] << (8 - width); // the highest bits repeat in the lowest
            ends[i][c] = c == 3 && mode.alpha_bits == 0 ? 255 : value | value >> width;
        }
    return ends;
}

/// @return sixty-fourths of the second endpoint
uint32_t weightOf(uint32_t index, uint32_t index_bits)
{
    return index_bits == 2 ? bc7::kWeights2[index] : index_bits == 3 ? bc7::kWeights3[index] : bc7::kWeights4[index];
}
} // namespace

Texels decodeBc4(std::span<const std::byte, 8> block)
{
    const std::array<uint8_t, 16> red = decodeChannel(block);
    Texels texels;
    for (size_t i = 0; i < 16; ++i)
        texels[i] = {red[i], 0, 0, 255};
    return texels;
}

Texels decodeBc5(std::span<const std::byte, 16> block)
{
    const std::array<uint8_t, 16> red = decodeChannel(block.first<8>());
    const std::array<uint8_t, 16> green = decodeChannel(block.last<8>());
    Texels texels;
    for (size_t i = 0; i < 16; ++i)
        texels[i] = {red[i], green[i], 0, 255};
    return texels;
}

Texels decodeBc7(std::span<const std::byte, 16> block)
{
    Texels texels{};
    const auto number = uint32_t(std::countr_zero(uint8_t(block[0])));
    if (number >= kBc7Modes.size())
        return texels;
    const Bc7Mode& mode = kBc7Modes[number];
    BitReader bits(block);
    bits.take(number + 1);
    const uint32_t partition = bits.take(mode.partition_bits);
    const uint32_t rotation = bits.take(mode.rotation_bits);
    const bool alpha_by_first = bits.take(mode.selection_bits) == 1;
    const Endpoints ends = readEndpoints(mode, bits);

    std::array<std::array<uint32_t, 16>, 2> weights{};
    for (uint32_t i = 0; i < 16; ++i)
        weights[0][i] = weightOf(bits.take(mode.index_bits - (isAnchor(mode, partition, i) ? 1 : 0)), mode.index_bits);
    for (uint32_t i = 0; i < 16 && mode.second_index_bits > 0; ++i)
        weights[1][i] = weightOf(bits.take(mode.second_index_bits - (i == 0 ? 1 : 0)), mode.second_index_bits);
    const bool separate = mode.second_index_bits > 0;
    const auto& color_weights = weights[separate && alpha_by_first ? 1 : 0];
    const auto& alpha_weights = weights[separate && !alpha_by_first ? 1 : 0];

    for (uint32_t i = 0; i < 16; ++i)
    {
        const uint32_t subset = subsetOf(mode, partition, i);
        for (uint32_t c = 0; c < 4; ++c)
            texels[i][c] = uint8_t(bc7::interpolate(ends[2 * subset][c], ends[2 * subset + 1][c],
                                                    c < 3 ? color_weights[i] : alpha_weights[i]));
        if (rotation > 0)
            std::swap(texels[i][3], texels[i][rotation - 1]);
    }
    return texels;
}
} // namespace blocks
