// Radiance pictures for tests, in every way one may be stored.
#pragma once
#include "image/image.h"

#include <cstddef>
#include <string>
#include <vector>

enum class HdrRuns
{
    kFlat,
    kOld, // (1, 1, 1, n) repeats a pixel
    kNew, // components by themselves
};

struct HdrStyle
{
    HdrRuns runs = HdrRuns::kNew;
    std::string magic = "#?RADIANCE";
    std::string lines = "FORMAT=32-bit_rle_rgbe\n"; // of the header, each ended
    std::string orientation = "-Y +X";              // the axis from line to line first
};

/// Values are cut to a shared exponent and eight bits.
std::vector<std::byte> writeHdr(const ImageF& image, const HdrStyle& style = {});

/// A picture whose values an .hdr holds exactly, with runs of equal pixels, of more than 255 where it is wide enough.
ImageF exactHdrImage(uint32_t width, uint32_t height, uint32_t seed);
