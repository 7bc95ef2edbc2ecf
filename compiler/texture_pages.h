// Gathers images of one size and encoding into array textures with mip chains: the package's texture pages.
#pragma once
#include "compiler/cache.h"
#include "compiler/scene_data.h"

#include <cstdint>
#include <string>
#include <vector>

struct TexturePage
{
    bool srgb = false;
    uint32_t width = 0;
    uint32_t height = 0;
    uint32_t layers = 0;
    uint32_t levels = 0;
    std::vector<uint8_t> texels; // RGBA8: level 0 of all layers, then level 1 of all layers, ...
};

struct TexturePages
{
    std::vector<TexturePage> pages;    // at most gpu::kTexturePageCount
    std::vector<gpu::TextureRef> refs; // [texture_use_count]
    uint32_t resized = 0;              // images that had to take another size so that the pages suffice
};

/// Mip levels are 2 x 2 box averages, of linear light for sRGB images. Frees the images' texels as it goes. What
/// each image becomes is looked for in `cache` first, by its texels and what is made of them.
TexturePages buildTexturePages(std::vector<TextureImage>& images, const std::vector<TextureUse>& uses,
                               const Cache& cache = {});

/// The next smaller mip level of one layer: RGBA8, sides halved and rounded down, at least 1.
void halveImage(const uint8_t* from, uint32_t width, uint32_t height, bool srgb, uint8_t* to);
