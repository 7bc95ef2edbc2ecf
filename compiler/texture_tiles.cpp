#include "compiler/texture_tiles.h"

#include "format/check.h"
#include "format/texture_tile.h"

#include <algorithm>
#include <bit>
#include <numeric>

TileSize tileExtent(TileSize size)
{
    TileSize extent{};
    const auto levels = uint32_t(std::bit_width(std::max(size.width, size.height)));
    for (uint32_t level = 0; level < levels; ++level)
    {
        extent.width = std::max(extent.width, gpu::tileLevelX(0, size.width, level) +
                                                  gpu::tileSide(gpu::levelSide(size.width, level)));
        extent.height = std::max(extent.height, gpu::tileLevelY(0, size.height, level) +
                                                    gpu::tileSide(gpu::levelSide(size.height, level)));
    }
    return extent;
}

TileLayout layTiles(std::span<const TileSize> sizes)
{
    constexpr uint64_t kGoodLayers = 128; // devices have 256 at least
    std::vector<TileSize> extents;
    uint32_t side = 64;
    uint64_t area = 0;
    for (const TileSize& size : sizes)
    {
        extents.push_back(tileExtent(size));
        side = std::max({side, extents.back().width, extents.back().height});
        area += uint64_t(extents.back().width) * extents.back().height;
    }
    side = std::bit_ceil(side);
    while (side < kMaxPageSide && area > kGoodLayers * side * side)
        side *= 2;
    check(side <= kMaxPageSide, "a tile of {} texels", side);

    std::vector<size_t> order(sizes.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return extents[a].height > extents[b].height; });
    TileLayout layout{side, 0, 1, std::vector<TilePlace>(sizes.size())};
    uint32_t x = 0, shelf = 0, shelf_height = 0;
    for (const size_t i : order)
    {
        if (x + extents[i].width > side)
            x = 0, shelf += shelf_height, shelf_height = 0;
        if (shelf + extents[i].height > side)
            x = shelf = shelf_height = 0, ++layout.layers;
        layout.places[i] = {layout.layers - 1, x, shelf};
        x += extents[i].width;
        shelf_height = std::max(shelf_height, extents[i].height);
        layout.height = std::max(layout.height, shelf + shelf_height);
    }
    return layout;
}
