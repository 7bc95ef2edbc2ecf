// Reads KTX 2.0 textures (Khronos KTX File Format Specification 2.0): two-dimensional ones, of which the largest level is decoded.
#pragma once
#include "format/result.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

struct Ktx2Image
{
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> texels; // [4 * width * height] RGBA8, row 0 on top
    std::vector<uint16_t> deep;  // the same in 16 bits where the file has more than 8, else empty
    bool linear_light = false;   // floats: colours are light, not sRGB-encoded; clamped to 0 .. 1
};

/// Whether the bytes start like a KTX 2.0 file.
bool isKtx2(std::span<const std::byte> bytes);

/// Formats: 8- and 16-bit unorm and 16- and 32-bit floats of one to four channels, BC1 to BC5, BC7; plain, zstd or zlib.
/// @param accept is called before texels are allocated, and may refuse
/// @return kInvalid for a damaged file, kUnsupported for other formats and for arrays, cubes and volumes; sentences without a
///         subject ("it is ...")
Result<Ktx2Image> decodeKtx2(std::span<const std::byte> bytes,
                             const std::function<Status(uint32_t width, uint32_t height)>& accept);
