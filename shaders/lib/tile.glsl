// Mapping of threads to pixels. Functions only.
#ifndef LIB_TILE_GLSL
#define LIB_TILE_GLSL

const uint kTileSide = 8u;

/// Threads process the picture tile by tile: neighbouring pixels read the same data, so those of a group should be near each other
/// both ways. Each number below `count` is mapped to one pixel.
/// @param width of the picture, @param count of its pixels
uint tiledPixel(uint thread, uint width, uint count)
{
    if (thread >= count)
        return thread;
    uint band = thread / (kTileSide * width), in_band = thread - band * kTileSide * width;
    uint band_height = min(kTileSide, count / width - band * kTileSide); // the last one may be lower
    uint tile = in_band / (kTileSide * band_height), in_tile = in_band - tile * kTileSide * band_height;
    uint tile_width = min(kTileSide, width - tile * kTileSide); // and the last tile narrower
    uint y = in_tile / tile_width, x = in_tile - y * tile_width;
    return (band * kTileSide + y) * width + tile * kTileSide + x;
}

#endif
