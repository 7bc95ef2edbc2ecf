#include "compiler/texture_pages.h"

#include "compiler/bc4_encode.h"
#include "compiler/bc7_encode.h"
#include "compiler/mip_chain.h"
#include "compiler/parallel.h"
#include "compiler/texture_plan.h"
#include "format/texture_tile.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace
{
using package::TextureEncoding;
constexpr uint64_t kBatchTexels = 64u << 20; // of level 0: bounds the memory that chains take
constexpr uint32_t kBandUnits = 1u << 14;    // blocks or texels that one piece of work writes, about

/// Some rows of blocks (or texels) of one level of one image, and where they go.
struct Band
{
    const MipChain* chain = nullptr;
    TextureRole role;
    uint32_t level = 0;
    TextureEncoding encoding{};
    bool tiled = false;
    uint32_t units_across = 0, first_row = 0, row_count = 0;
    uint8_t* out = nullptr; // of row 0
    size_t pitch = 0;       // bytes from row to row
};

/// The texel of the image that place (x, y) of the page's part shows: past the edge it goes on as the last one, in a tile
/// anew.
std::array<float, 4> texelAt(const Band& band, uint32_t x, uint32_t y)
{
    const uint32_t width = band.chain->width(band.level), height = band.chain->height(band.level);
    std::array<float, 4> texel = band.tiled
                                     ? band.chain->texel(band.level, (x + width - gpu::kTileBorder) % width,
                                                         (y + height - gpu::kTileBorder) % height)
                                     : band.chain->texel(band.level, std::min(x, width - 1), std::min(y, height - 1));
    if (band.encoding == TextureEncoding::Bc5Unorm)
        normalizeTexel(texel);
    return texel;
}

void writeTexels(const Band& band, uint32_t y)
{
    uint8_t* to = band.out + band.pitch * y;
    for (uint32_t x = 0; x < band.units_across; ++x)
        for (const float value : texelAt(band, x, y))
            *to++ = uint8_t(value + 0.5f);
}

void writeBlocks(const Band& band, uint32_t row)
{
    const uint32_t bytes = package::unitBytes(band.encoding);
    auto* to = reinterpret_cast<std::byte*>(band.out + band.pitch * row);
    for (uint32_t column = 0; column < band.units_across; ++column, to += bytes)
    {
        std::array<Lanes, 4> channels;
        for (uint32_t i = 0; i < 16; ++i)
        {
            const std::array<float, 4> texel =
                texelAt(band, blocks::kSide * column + i % blocks::kSide, blocks::kSide * row + i / blocks::kSide);
            for (size_t k = 0; k < 4; ++k)
                channels[k].set(i, (band.role.channels >> k & 1) != 0 ? texel[k] : 0);
        }
        if (band.encoding == TextureEncoding::Bc4Unorm || band.encoding == TextureEncoding::Bc5Unorm)
            encodeBc4(channels[0], std::span<std::byte, 8>(to, 8));
        if (band.encoding == TextureEncoding::Bc5Unorm)
            encodeBc4(channels[1], std::span<std::byte, 8>(to + 8, 8));
        if (bytes == 16 && band.encoding != TextureEncoding::Bc5Unorm)
            encodeBc7(channels, (band.role.channels & gpu::kAlpha) != 0, std::span<std::byte, 16>(to, 16));
    }
}

/// One level as it goes into its page, in bands.
void addBands(const TextureImage& image, const TextureRole& role, uint32_t level, const TexturePlace& place,
              TexturePage& page, std::vector<Band>& bands)
{
    const auto across = [&](uint32_t side) { return package::unitsAcross(page.encoding, side); };
    const uint32_t unit_bytes = package::unitBytes(page.encoding);
    const uint32_t width = gpu::levelSide(image.width, level), height = gpu::levelSide(image.height, level);
    Band band{nullptr, role, level, page.encoding, page.tiled};
    uint32_t rows = 0;
    if (page.tiled)
    {
        band.units_across = across(gpu::tileSide(width));
        rows = across(gpu::tileSide(height));
        band.pitch = size_t(across(page.width)) * unit_bytes;
        band.out = page.texels.data() + package::levelBytes(page.encoding, page.width, page.height) * place.layer +
                   band.pitch * across(gpu::tileLevelY(place.y, image.height, level)) +
                   size_t(unit_bytes) * across(gpu::tileLevelX(place.x, image.width, level));
    }
    else
    {
        band.units_across = across(width);
        rows = across(height);
        band.pitch = size_t(band.units_across) * unit_bytes;
        band.out = page.texels.data() + package::levelBytes(page.encoding, width, height) * place.layer;
        for (uint32_t i = 0; i < level; ++i)
            band.out +=
                package::levelBytes(page.encoding, gpu::levelSide(image.width, i), gpu::levelSide(image.height, i)) *
                page.layers;
    }
    const uint32_t band_rows = std::max(kBandUnits / band.units_across, 1u);
    for (band.first_row = 0; band.first_row < rows; band.first_row += band_rows)
    {
        band.row_count = std::min(band_rows, rows - band.first_row);
        bands.push_back(band);
    }
}

void writeBand(const Band& band)
{
    for (uint32_t row = band.first_row; row < band.first_row + band.row_count; ++row)
        if (package::isBlocks(band.encoding))
            writeBlocks(band, row);
        else
            writeTexels(band, row);
}

/// What is to be done for one image.
struct ImageWork
{
    size_t image = 0;
    std::vector<Band> bands; // all levels
    ContentHash key;         // of what it becomes
    bool is_there = false;   // it came from the cache
    std::optional<MipChain> chain;
};

/// Visits what the bands cover, row by row.
template <typename Visit>
void forEachRow(const std::vector<Band>& bands, const Visit& visit)
{
    for (const Band& band : bands)
        for (uint32_t row = band.first_row; row < band.first_row + band.row_count; ++row)
            visit(band.out + band.pitch * row, size_t(band.units_across) * package::unitBytes(band.encoding));
}

ContentHash workKey(const TextureImage& image, const TextureRole& role, const TexturePage& page)
{
    return Hasher("texture")
        .values(image.width, image.height, uint32_t(page.encoding), uint32_t(page.tiled), role.channels,
                uint32_t(role.normal), uint32_t(role.covers), role.coverage_cutoff, uint32_t(image.srgb))
        .array(image.texels)
        .array(image.deep)
        .finish();
}

/// @return whether the cache had it: it is in its page then
bool fetch(const ImageWork& work, const Cache& cache)
{
    const auto found = cache.find(work.key);
    size_t bytes = 0;
    forEachRow(work.bands, [&](uint8_t*, size_t row_bytes) { bytes += row_bytes; });
    if (!found || found->size() != bytes)
        return false;
    const std::byte* from = found->data();
    forEachRow(work.bands,
               [&](uint8_t* to, size_t row_bytes)
               {
                   std::memcpy(to, from, row_bytes);
                   from += row_bytes;
               });
    return true;
}

void keep(const ImageWork& work, const Cache& cache)
{
    std::vector<std::span<const std::byte>> rows;
    forEachRow(work.bands,
               [&](uint8_t* row, size_t row_bytes) { rows.push_back(std::as_bytes(std::span(row, row_bytes))); });
    cache.store(work.key, rows);
}

/// Writes images [begin, end) into their pages.
void writeImages(std::vector<TextureImage>& images, std::span<const TextureRole> roles, TexturePlan& plan, size_t begin,
                 size_t end, const Cache& cache)
{
    std::vector<ImageWork> works;
    for (size_t i = begin; i < end; ++i)
        if (plan.same_as[i] == i)
            works.push_back({.image = i, .bands = {}, .key = {}, .is_there = false, .chain = {}});
    parallelFor(works.size(),
                [&](size_t w)
                {
                    ImageWork& work = works[w];
                    const size_t i = work.image;
                    TexturePage& page = plan.pages[plan.places[i].page];
                    const uint32_t levels = levelCount(images[i].width, images[i].height);
                    for (uint32_t level = 0; level < levels; ++level)
                        addBands(images[i], roles[i], level, plan.places[i], page, work.bands);
                    if (cache.isOpen())
                    {
                        work.key = workKey(images[i], roles[i], page);
                        work.is_there = fetch(work, cache);
                    }
                    if (!work.is_there)
                        work.chain.emplace(images[i], roles[i]);
                });
    std::vector<Band> bands;
    for (const ImageWork& work : works)
        if (!work.is_there)
            for (Band band : work.bands)
            {
                band.chain = &*work.chain;
                bands.push_back(band);
            }
    parallelFor(bands.size(), [&](size_t i) { writeBand(bands[i]); });
    if (cache.isOpen())
        parallelFor(works.size(),
                    [&](size_t w)
                    {
                        if (!works[w].is_there)
                            keep(works[w], cache);
                    });
    for (size_t i = begin; i < end; ++i)
        images[i].texels = {}, images[i].deep = {};
}

gpu::TextureRef reference(const TextureUse& use, const TextureImage& image, const TexturePlace& place,
                          const TexturePage& page)
{
    return {.page = place.page,
            .layer = place.layer,
            .sampling = use.sampling | (page.tiled ? gpu::kSampleTile : 0u) |
                        (page.encoding == TextureEncoding::Bc5Unorm ? gpu::kSampleNormalXy : 0u),
            .origin = place.x | place.y << 16,
            .size = image.width | image.height << 16,
            .u_row = use.u_row,
            .v_row = use.v_row};
}
} // namespace

TexturePages buildTexturePages(std::vector<TextureImage>& images, const std::vector<TextureUse>& uses,
                               std::span<const gpu::Material> materials, TextureCompression compression,
                               const Cache& cache)
{
    const std::vector<TextureRole> roles = textureRoles(materials, uses, images.size());
    TexturePlan plan = planTextures(images, roles, compression);
    for (size_t begin = 0, end = 0; begin < images.size(); begin = end)
    {
        uint64_t texels = 0;
        for (; end < images.size() && (end == begin || texels < kBatchTexels); ++end)
            texels += uint64_t(images[end].width) * images[end].height;
        writeImages(images, roles, plan, begin, end, cache);
    }
    TexturePages out{std::move(plan.pages), {}, plan.halved};
    for (const TextureUse& use : uses)
        out.refs.push_back(
            reference(use, images[use.image], plan.places[use.image], out.pages[plan.places[use.image].page]));
    return out;
}
