// The chunks of a PNG file: length, type, data, checksum.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

inline constexpr std::array<uint8_t, 8> kPngMagic{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
inline constexpr size_t kPngChunkOverhead = 12; // bytes beside the data
inline constexpr size_t kPngHeaderBytes = 13;
inline constexpr uint32_t kPngHeader = 0x49484452, kPngText = 0x74455874, kPngEnd = 0x49454e44; // IHDR, tEXt, IEND

/// The number at byte `at`, its highest byte first.
inline uint32_t bigEndian(std::span<const std::byte> bytes, size_t at)
{
    uint32_t value = 0;
    for (size_t i = 0; i < 4; ++i)
        value = value << 8 | uint32_t(bytes[at + i]);
    return value;
}

/// Calls visit(type, data) for each chunk behind the magic number, until it returns false or the file ends.
template <typename Visit>
void forEachPngChunk(std::span<const std::byte> file, const Visit& visit)
{
    size_t at = kPngMagic.size();
    while (file.size() >= at + kPngChunkOverhead)
    {
        const uint64_t length = bigEndian(file, at);
        if (length > file.size() - at - kPngChunkOverhead)
            return;
        if (!visit(bigEndian(file, at + 4), file.subspan(at + 8, length)))
            return;
        at += kPngChunkOverhead + length;
    }
}
