// Where the levels of a tile lie in its page: a page of tiles holds textures of many sizes, each with all its levels side by
// side. Every level has a border of the texels that follow where the texture repeats, so that bilinear filtering needs only
// a single lookup; levels start at multiples of 4 texels, as blocks do. Shared by C++ and GLSL.
#ifndef FORMAT_TEXTURE_TILE_H
#define FORMAT_TEXTURE_TILE_H
#include "format/gpu_types.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kTileBorder = 1u; // texels

/// Texels of level `level` of a texture along a side of `side`.
GPU_FUNCTION uint levelSide(uint side, uint level)
{
    uint halved = side >> level;
    return halved > 0u ? halved : 1u;
}

/// The same with borders, up to whole blocks.
GPU_FUNCTION uint tileSide(uint side)
{
    return (side + 2u * kTileBorder + 3u) & ~3u;
}

/// Level 0 lies at the tile's origin, the smaller ones to the right of it, one below the other.
GPU_FUNCTION uint tileLevelX(uint origin, uint width, uint level)
{
    return level == 0u ? origin : origin + tileSide(width);
}
GPU_FUNCTION uint tileLevelY(uint origin, uint height, uint level)
{
    uint y = origin;
    for (uint i = 1u; i < level; ++i)
        y += tileSide(levelSide(height, i));
    return y;
}

GPU_NAMESPACE_END
#endif
