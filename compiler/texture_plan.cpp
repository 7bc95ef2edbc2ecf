#include "compiler/texture_plan.h"

#include "compiler/mip_chain.h"
#include "compiler/texture_tiles.h"
#include "format/check.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <map>
#include <set>
#include <string_view>
#include <unordered_map>

namespace
{
using package::TextureEncoding;
constexpr size_t kMaxLayers = 2048; // of a page

/// What images of one plain page have in common; ordered, so that the order of pages is deterministic.
struct PageKey
{
    TextureEncoding encoding;
    uint32_t width;
    uint32_t height;
    size_t part; // of more than kMaxLayers
    auto operator<=>(const PageKey&) const = default;
};
using Groups = std::map<PageKey, std::vector<size_t>>; // image indices
using Group = Groups::value_type;

/// Whether more than one in a hundred unit vectors points into the surface: two channels cannot store the sign of z.
bool hasBackwardNormals(const TextureImage& image)
{
    size_t backward = 0;
    for (size_t i = 2; i < image.texels.size(); i += 4)
        backward += image.texels[i] < 127 ? 1 : 0;
    return backward * 100 > image.texels.size() / 4;
}

TextureEncoding encodingOf(const TextureImage& image, const TextureRole& role, TextureCompression compression)
{
    if (compression == TextureCompression::kRaw)
        return image.srgb ? TextureEncoding::Rgba8Srgb : TextureEncoding::Rgba8Unorm;
    if (image.srgb)
        return TextureEncoding::Bc7Srgb;
    if (role.normal && !hasBackwardNormals(image))
        return TextureEncoding::Bc5Unorm;
    return role.channels == gpu::kRed ? TextureEncoding::Bc4Unorm : TextureEncoding::Bc7Unorm;
}

std::vector<size_t> findEqual(const std::vector<TextureImage>& images, std::span<const TextureRole> roles)
{
    std::vector<size_t> same_as(images.size());
    std::unordered_multimap<size_t, size_t> by_hash;
    for (size_t i = 0; i < images.size(); ++i)
    {
        const TextureImage& image = images[i];
        const std::string_view bytes(reinterpret_cast<const char*>(image.texels.data()), image.texels.size());
        const size_t hash = std::hash<std::string_view>()(bytes);
        const auto [begin, end] = by_hash.equal_range(hash);
        const auto found = std::find_if(begin, end,
                                        [&](const auto& entry)
                                        {
                                            const TextureImage& other = images[entry.second];
                                            return image.width == other.width && image.height == other.height &&
                                                   image.srgb == other.srgb && roles[i] == roles[entry.second] &&
                                                   image.texels == other.texels && image.deep == other.deep;
                                        });
        same_as[i] = found == end ? i : found->second;
        if (found == end)
            by_hash.emplace(hash, i);
    }
    return same_as;
}

TileSize sizeOf(const PageKey& key)
{
    return {key.width, key.height};
}

/// The order in which images get a page of their own: first those that no tile can hold, then by memory.
std::vector<const Group*> byWorth(const Groups& groups)
{
    std::vector<const Group*> order;
    for (const Group& group : groups)
        order.push_back(&group);
    const auto worth = [](const Group* g)
    { return std::pair(!isTileable(sizeOf(g->first)), uint64_t(g->first.width) * g->first.height * g->second.size()); };
    std::stable_sort(order.begin(), order.end(), [&](const Group* a, const Group* b) { return worth(a) > worth(b); });
    return order;
}

/// How many of `order` have a page of their own, so that those and a tiled page for every encoding of the others suffice.
size_t ownPageCount(const std::vector<const Group*>& order)
{
    if (order.size() <= gpu::kTexturePageCount)
        return order.size();
    size_t own = gpu::kTexturePageCount;
    std::set<TextureEncoding> tiled;
    for (size_t i = own; i < order.size(); ++i)
        tiled.insert(order[i]->first.encoding);
    while (own + tiled.size() > gpu::kTexturePageCount)
        tiled.insert(order[--own]->first.encoding);
    return own;
}

void halve(TextureImage& image, const TextureRole& role)
{
    const MipChain chain(image, role);
    TextureImage smaller{image.name, chain.width(1), chain.height(1), image.srgb, {}};
    for (uint32_t y = 0; y < smaller.height; ++y)
        for (uint32_t x = 0; x < smaller.width; ++x)
            for (const float value : chain.texel(1, x, y))
                smaller.texels.push_back(uint8_t(std::lround(value)));
    image = std::move(smaller);
}

void allocate(TexturePage& page)
{
    size_t bytes = 0;
    for (uint32_t level = 0; level < page.levels; ++level)
        bytes += page.layers * package::levelBytes(page.encoding, std::max(page.width >> level, 1u),
                                                   std::max(page.height >> level, 1u));
    page.texels.resize(bytes);
}

void addPlainPage(const Group& group, TexturePlan& plan)
{
    const PageKey& key = group.first;
    for (size_t layer = 0; layer < group.second.size(); ++layer)
        plan.places[group.second[layer]] = {uint32_t(plan.pages.size()), uint32_t(layer)};
    plan.pages.push_back({key.encoding,
                          false,
                          key.width,
                          key.height,
                          uint32_t(group.second.size()),
                          levelCount(key.width, key.height),
                          {}});
}

void addTiledPage(TextureEncoding encoding, const std::vector<const Group*>& groups, TexturePlan& plan)
{
    std::vector<TileSize> sizes;
    std::vector<size_t> images;
    for (const Group* group : groups)
        for (const size_t image : group->second)
        {
            sizes.push_back(sizeOf(group->first));
            images.push_back(image);
        }
    const TileLayout layout = layTiles(sizes);
    for (size_t i = 0; i < images.size(); ++i)
        plan.places[images[i]] = {uint32_t(plan.pages.size()), layout.places[i].layer, layout.places[i].x,
                                  layout.places[i].y};
    plan.pages.push_back({encoding, true, layout.width, layout.height, layout.layers, 1, {}});
}
} // namespace

TexturePlan planTextures(std::vector<TextureImage>& images, std::span<const TextureRole> roles,
                         TextureCompression compression)
{
    TexturePlan plan;
    plan.places.resize(images.size());
    plan.same_as = findEqual(images, roles);
    const auto gather = [&]
    {
        Groups groups;
        std::map<PageKey, size_t> counts;
        for (size_t i = 0; i < images.size(); ++i)
            if (plan.same_as[i] == i)
            {
                PageKey key{encodingOf(images[i], roles[i], compression), images[i].width, images[i].height, 0};
                key.part = counts[key]++ / kMaxLayers;
                groups[key].push_back(i);
            }
        return groups;
    };
    Groups groups = gather();
    std::vector<const Group*> order = byWorth(groups);
    while (ownPageCount(order) < order.size() && !isTileable(sizeOf(order[ownPageCount(order)]->first)))
    {
        for (const size_t i : order[ownPageCount(order)]->second)
        {
            halve(images[i], roles[i]);
            ++plan.halved;
        }
        groups = gather();
        order = byWorth(groups);
    }

    const size_t own = ownPageCount(order);
    std::set<PageKey> own_keys;
    for (size_t i = 0; i < own; ++i)
        own_keys.insert(order[i]->first);
    std::map<TextureEncoding, std::vector<const Group*>> tiled;
    for (const Group& group : groups)
        if (own_keys.contains(group.first))
            addPlainPage(group, plan);
        else
            tiled[group.first.encoding].push_back(&group);
    for (const auto& [encoding, members] : tiled)
        addTiledPage(encoding, members, plan);
    check(plan.pages.size() <= gpu::kTexturePageCount, "{} pages", plan.pages.size());
    for (TexturePage& page : plan.pages)
        allocate(page);
    for (size_t i = 0; i < images.size(); ++i)
        plan.places[i] = plan.places[plan.same_as[i]];
    return plan;
}
