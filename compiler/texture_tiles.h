// Lays textures of many sizes, each with its levels, side by side into the layers of one page (format/texture_tile.h).
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

inline constexpr uint32_t kMaxPageSide = 16384; // texels

struct TileSize // of level 0, texels
{
    uint32_t width = 0, height = 0;
};
struct TilePlace
{
    uint32_t layer = 0, x = 0, y = 0; // x and y in texels, multiples of 4
};
struct TileLayout
{
    uint32_t width = 0, height = 0, layers = 0; // of the page
    std::vector<TilePlace> places;              // one a tile
};

/// A tile with all its levels and their borders.
TileSize tileExtent(TileSize size);

inline bool isTileable(TileSize size)
{
    const TileSize extent = tileExtent(size);
    return extent.width <= kMaxPageSide && extent.height <= kMaxPageSide;
}

/// In shelves, the highest tiles first. @param sizes each isTileable(), at least one
TileLayout layTiles(std::span<const TileSize> sizes);
