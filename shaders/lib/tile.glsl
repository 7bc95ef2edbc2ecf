// Mapping of threads to pixels. Functions only.
#ifndef LIB_TILE_GLSL
#define LIB_TILE_GLSL
#include "shaders/lib/math.glsl"

const uint kTileSide = 8u;

/// Threads process the picture tile by tile: neighbouring pixels read the same data, so those of a group should be near each other
/// both ways; in a whole tile, those of 8 threads too, which lie in a block of 4 x 2. Each number below `count` is mapped to one
/// pixel.
/// @param width of the picture, @param count of its pixels
uint tiledPixel(uint thread, uint width, uint count)
{
    if (thread >= count)
        return thread;
    uint band = quotient(thread, kTileSide * width), in_band = thread - band * kTileSide * width;
    uint band_height = min(kTileSide, quotient(count, width) - band * kTileSide); // the last one may be lower
    uint tile_size = kTileSide * band_height;
    uint tile = quotient(in_band, tile_size), in_tile = in_band - tile * tile_size;
    uint tile_width = min(kTileSide, width - tile * kTileSide); // and the last tile narrower
    uint y = quotient(in_tile, tile_width), x = in_tile - y * tile_width;
    if (tile_width * band_height == kTileSide * kTileSide)
    {
        x = (in_tile & 3u) | ((in_tile >> 1) & 4u);
        y = ((in_tile >> 2) & 1u) | ((in_tile >> 3) & 6u);
    }
    return (band * kTileSide + y) * width + tile * kTileSide + x;
}

#endif
