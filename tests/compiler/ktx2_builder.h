// Writes KTX 2.0 files of one level, for the tests.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

struct Ktx2Header
{
    uint32_t vk_format = 37; // RGBA8
    uint32_t type_size = 1;
    uint32_t width = 1, height = 1, depth = 0;
    uint32_t layers = 0, faces = 1, levels = 1;
    uint32_t supercompression = 0;
    uint32_t color_model = 1; // of the data format descriptor
    uint64_t raw_bytes = 0;   // of the level; 0: as stored
};

inline std::vector<std::byte> makeKtx2(const Ktx2Header& h, std::span<const std::byte> level)
{
    static constexpr unsigned char kIdentifier[12] = {0xAB, 'K', 'T', 'X', ' ', '2', '0', 0xBB, '\r', '\n', 0x1A, '\n'};
    constexpr uint32_t kDescriptor = 104, kDescriptorBytes = 28, kLevel = 144;
    std::vector<std::byte> file(kLevel + level.size());
    const auto put = [&](size_t at, auto value) { std::memcpy(file.data() + at, &value, sizeof(value)); };
    std::memcpy(file.data(), kIdentifier, sizeof(kIdentifier));
    const uint32_t words[] = {h.vk_format, h.type_size,        h.width,     h.height,        h.depth, h.layers, h.faces,
                              h.levels,    h.supercompression, kDescriptor, kDescriptorBytes};
    std::memcpy(file.data() + sizeof(kIdentifier), words, sizeof(words));
    put(80, uint64_t(kLevel));
    put(88, uint64_t(level.size()));
    put(96, h.raw_bytes != 0 ? h.raw_bytes : uint64_t(level.size()));
    put(kDescriptor, kDescriptorBytes);
    put(kDescriptor + 12, h.color_model);
    if (!level.empty())
        std::memcpy(file.data() + kLevel, level.data(), level.size());
    return file;
}
