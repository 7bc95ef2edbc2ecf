// Gathers images into array textures with mip chains, the package's texture pages, and compresses them.
#pragma once
#include "compiler/cache.h"
#include "compiler/scene_data.h"
#include "format/texture_encoding.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

enum class TextureCompression
{
    kBlocks, // BC7 for colour and data, BC5 for normals, BC4 for what is read of one channel
    kRaw     // RGBA8
};

struct TexturePage
{
    package::TextureEncoding encoding = package::TextureEncoding::Rgba8Unorm;
    bool tiled = false;
    uint32_t width = 0;
    uint32_t height = 0;
    uint32_t layers = 0;
    uint32_t levels = 0;
    std::vector<uint8_t> texels; // or blocks: level 0 of all layers, then level 1 of all layers, ...
};

struct TexturePages
{
    std::vector<TexturePage> pages;    // at most gpu::kTexturePageCount
    std::vector<gpu::TextureRef> refs; // [texture_use_count]
    uint32_t halved = 0;               // images beyond 8192 texels, of too many different sizes for the pages there are
};

/// Every size and encoding has a page of its own; where those would be too many, the smallest share tiled pages. Images that
/// are equal are stored once. Frees the images' texels. What each image becomes is looked for in `cache` first.
TexturePages buildTexturePages(std::vector<TextureImage>& images, const std::vector<TextureUse>& uses,
                               std::span<const gpu::Material> materials, TextureCompression compression,
                               const Cache& cache = {});
