// Block-compressed texels as Direct3D and Vulkan define them (Khronos Data Format Specification 1.3, chapters 18 to 21): 4 x 4 texels a
// block, row 0 of blocks first; blocks at the right and lower edge reach past the texture.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace blocks
{
inline constexpr uint32_t kSide = 4; // texels

inline constexpr uint32_t acrossSide(uint32_t texels)
{
    return (texels + kSide - 1) / kSide;
}
inline constexpr uint64_t countIn(uint32_t width, uint32_t height)
{
    return uint64_t(acrossSide(width)) * acrossSide(height);
}

using Texels = std::array<std::array<uint8_t, 4>, 16>; // RGBA8, row by row

/// Any 8 or 16 bytes are a block. What a format lacks reads 0 in colour and 255 in alpha.
Texels decodeBc4(std::span<const std::byte, 8> block);  // red
Texels decodeBc5(std::span<const std::byte, 16> block); // red and green
Texels decodeBc7(std::span<const std::byte, 16> block); // reserved modes read 0 in all channels
} // namespace blocks
