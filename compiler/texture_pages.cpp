#include "compiler/texture_pages.h"

#include "compiler/parallel.h"
#include "format/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstring>
#include <map>

namespace
{
/// What images of one page have in common; ordered, so that pages come in one order always.
struct PageKey
{
    uint32_t width;
    uint32_t height;
    bool srgb;
    auto operator<=>(const PageKey&) const = default;
    uint64_t texels() const { return uint64_t(width) * height; }
};
using Groups = std::map<PageKey, std::vector<uint32_t>>; // image indices

constexpr uint32_t kLinearSteps = 4096; // of the table back to sRGB; finer than its darkest step (1 / 3295)

struct SrgbTables
{
    std::array<float, 256> to_linear;
    std::array<uint8_t, kLinearSteps + 1> from_linear;

    SrgbTables()
    {
        for (int i = 0; i < 256; ++i)
        {
            const double s = i / 255.0;
            to_linear[size_t(i)] = float(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
        }
        for (uint32_t i = 0; i <= kLinearSteps; ++i)
        {
            const double l = double(i) / kLinearSteps;
            const double s = l <= 0.0031308 ? l * 12.92 : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
            from_linear[i] = uint8_t(std::lround(s * 255));
        }
    }
};

const SrgbTables& srgbTables()
{
    static const SrgbTables tables;
    return tables;
}

uint32_t levelCount(uint32_t width, uint32_t height)
{
    uint32_t levels = 1;
    for (uint32_t side = std::max(width, height); side > 1; side /= 2)
        ++levels;
    return levels;
}

uint32_t half(uint32_t side)
{
    return std::max(side / 2, 1u);
}

/// Bilinear resampling, in linear light for sRGB images. Only for images that must join another page.
std::vector<uint8_t> resample(const TextureImage& image, uint32_t width, uint32_t height)
{
    const SrgbTables& tables = srgbTables();
    std::vector<uint8_t> out(size_t(4) * width * height);
    const auto tap = [](uint32_t i, uint32_t count, uint32_t source_count) {
        return std::clamp((float(i) + 0.5f) * float(source_count) / float(count) - 0.5f, 0.0f, float(source_count - 1));
    };
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
        {
            const float sx = tap(x, width, image.width), sy = tap(y, height, image.height);
            const uint32_t x0 = uint32_t(sx), y0 = uint32_t(sy);
            const uint32_t x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
            const float fx = sx - float(x0), fy = sy - float(y0);
            for (uint32_t c = 0; c < 4; ++c)
            {
                const bool decode = image.srgb && c < 3;
                const auto at = [&](uint32_t px, uint32_t py)
                {
                    const uint8_t v = image.texels[(size_t(py) * image.width + px) * 4 + c];
                    return decode ? tables.to_linear[v] : float(v);
                };
                const float v = (at(x0, y0) * (1 - fx) + at(x1, y0) * fx) * (1 - fy) +
                                (at(x0, y1) * (1 - fx) + at(x1, y1) * fx) * fy;
                out[(size_t(y) * width + x) * 4 + c] =
                    decode ? tables.from_linear[size_t(v * kLinearSteps + 0.5f)] : uint8_t(v + 0.5f);
            }
        }
    return out;
}

/// The group that a group with `key` is cheapest to join: the next larger of its encoding, else the largest.
Groups::iterator joinTarget(Groups& groups, const PageKey& key)
{
    auto best = groups.end();
    const auto cost = [&](const PageKey& k) // larger pages first by size, smaller ones only where there is none
    { return k.texels() >= key.texels() ? k.texels() : (uint64_t(1) << 40) - k.texels(); };
    for (auto it = groups.begin(); it != groups.end(); ++it)
        if (it->first.srgb == key.srgb && it->first != key &&
            (best == groups.end() || cost(it->first) < cost(best->first)))
            best = it;
    return best;
}

/// Merges the smallest groups into others until the pages suffice.
void limitGroups(Groups& groups)
{
    const auto memory = [](const Groups::value_type& group) { return group.first.texels() * group.second.size(); };
    while (groups.size() > gpu::kTexturePageCount)
    {
        auto smallest = groups.end();
        for (auto it = groups.begin(); it != groups.end(); ++it)
            if (joinTarget(groups, it->first) != groups.end() &&
                (smallest == groups.end() || memory(*it) < memory(*smallest)))
                smallest = it;
        check(smallest != groups.end(), "{} groups", groups.size());
        std::vector<uint32_t>& into = joinTarget(groups, smallest->first)->second;
        into.insert(into.end(), smallest->second.begin(), smallest->second.end());
        std::sort(into.begin(), into.end());
        groups.erase(smallest);
    }
}

TexturePage emptyPage(const PageKey& key, uint32_t layers)
{
    TexturePage page{key.srgb, key.width, key.height, layers, levelCount(key.width, key.height), {}};
    size_t texels = 0;
    for (uint32_t level = 0, w = key.width, h = key.height; level < page.levels; ++level, w = half(w), h = half(h))
        texels += size_t(w) * h * layers;
    page.texels.resize(4 * texels);
    return page;
}

/// What one image becomes: all its levels, the largest first.
std::vector<uint8_t> layerLevels(const TexturePage& page, const TextureImage& image)
{
    std::vector<uint8_t> levels(page.texels.size() / page.layers);
    const bool fits = image.width == page.width && image.height == page.height;
    const std::vector<uint8_t> resampled = fits ? std::vector<uint8_t>() : resample(image, page.width, page.height);
    const std::vector<uint8_t>& largest = fits ? image.texels : resampled;
    std::memcpy(levels.data(), largest.data(), largest.size());
    uint8_t* level = levels.data();
    for (uint32_t i = 1, w = page.width, h = page.height; i < page.levels; ++i, w = half(w), h = half(h))
    {
        uint8_t* const smaller = level + size_t(4) * w * h;
        halveImage(level, w, h, page.srgb, smaller);
        level = smaller;
    }
    return levels;
}

ContentHash layerKey(const TexturePage& page, const TextureImage& image)
{
    return Hasher("texture")
        .values(image.width, image.height, page.width, page.height, page.levels, uint32_t(page.srgb))
        .array(image.texels)
        .finish();
}

/// Puts the levels of one layer between those of the others.
void placeLayer(TexturePage& page, uint32_t layer, const std::vector<uint8_t>& levels)
{
    const uint8_t* from = levels.data();
    uint8_t* level = page.texels.data(); // of layer 0
    for (uint32_t i = 0, w = page.width, h = page.height; i < page.levels; ++i, w = half(w), h = half(h))
    {
        const size_t bytes = size_t(4) * w * h;
        std::memcpy(level + bytes * layer, from, bytes);
        from += bytes;
        level += bytes * page.layers;
    }
}
} // namespace

void halveImage(const uint8_t* from, uint32_t width, uint32_t height, bool srgb, uint8_t* to)
{
    const SrgbTables& tables = srgbTables();
    const uint32_t out_width = half(width);
    const uint32_t out_height = half(height);
    const size_t right = width > 1 ? 4 : 0;
    const size_t down = height > 1 ? size_t(width) * 4 : 0;
    for (uint32_t y = 0; y < out_height; ++y)
    {
        const uint8_t* p = from + 2 * y * down;
        for (uint32_t x = 0; x < out_width; ++x, p += 2 * right, to += 4)
        {
            for (int c = 0; c < 3; ++c)
            {
                const uint8_t* q = p + c;
                if (srgb)
                {
                    const float sum = tables.to_linear[q[0]] + tables.to_linear[q[right]] + tables.to_linear[q[down]] +
                                      tables.to_linear[q[right + down]];
                    to[c] = tables.from_linear[size_t(sum * (kLinearSteps / 4.0f) + 0.5f)];
                }
                else
                    to[c] = uint8_t((q[0] + q[right] + q[down] + q[right + down] + 2) / 4);
            }
            to[3] = uint8_t((p[3] + p[3 + right] + p[3 + down] + p[3 + right + down] + 2) / 4);
        }
    }
}

TexturePages buildTexturePages(std::vector<TextureImage>& images, const std::vector<TextureUse>& uses,
                               const Cache& cache)
{
    Groups groups;
    for (uint32_t i = 0; i < images.size(); ++i)
        groups[{images[i].width, images[i].height, images[i].srgb}].push_back(i);
    limitGroups(groups);

    struct Place
    {
        uint32_t page = 0;
        uint32_t layer = 0;
    };
    TexturePages result;
    std::vector<Place> places(images.size());
    for (const auto& [key, members] : groups)
    {
        for (uint32_t layer = 0; layer < members.size(); ++layer)
        {
            const TextureImage& image = images[members[layer]];
            places[members[layer]] = {uint32_t(result.pages.size()), layer};
            result.resized += image.width != key.width || image.height != key.height;
        }
        result.pages.push_back(emptyPage(key, uint32_t(members.size())));
    }
    parallelFor(images.size(),
                [&](size_t i)
                {
                    TexturePage& page = result.pages[places[i].page];
                    const auto make = [&] { return layerLevels(page, images[i]); };
                    std::vector<uint8_t> levels =
                        cache.isOpen() ? cache.through(layerKey(page, images[i]), make) : make();
                    if (levels.size() != page.texels.size() / page.layers)
                        levels = make(); // a cached result of another size was not made by layerLevels()
                    images[i].texels = {};
                    placeLayer(page, places[i].layer, levels);
                });
    for (const TextureUse& use : uses)
        result.refs.push_back({places[use.image].page, places[use.image].layer, use.sampling, use.u_row, use.v_row});
    return result;
}
