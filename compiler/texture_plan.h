// Decides which image goes where: encodings, pages, layers and tiles.
#pragma once
#include "compiler/texture_pages.h"
#include "compiler/texture_role.h"

#include <algorithm>
#include <bit>
#include <vector>

struct TexturePlace
{
    uint32_t page = 0, layer = 0;
    uint32_t x = 0, y = 0; // of a tile
};

struct TexturePlan
{
    std::vector<TexturePage> pages;   // texels allocated, not written
    std::vector<TexturePlace> places; // one an image
    std::vector<size_t> same_as;      // the first image equal to this one: itself, where none is
    uint32_t halved = 0;
};

/// @param images may be halved, see TexturePages::halved
TexturePlan planTextures(std::vector<TextureImage>& images, std::span<const TextureRole> roles,
                         TextureCompression compression);

inline uint32_t levelCount(uint32_t width, uint32_t height)
{
    return uint32_t(std::bit_width(std::max(width, height)));
}
