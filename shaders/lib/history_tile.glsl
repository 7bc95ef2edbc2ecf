// Tiles of the picture, each the work of one group. The kernel declares `HistoryParams params` before it includes this.
// Functions only.
#ifndef LIB_HISTORY_TILE_GLSL
#define LIB_HISTORY_TILE_GLSL
#include "shaders/history/history.h"

ivec2 pictureSize() { return ivec2(params.width, params.point_count / params.width); }
/// Tiles along either side; those at the right and at the bottom may stick out.
ivec2 tileCounts() { return (pictureSize() + int(kHistoryTileSide) - 1) / int(kHistoryTileSide); }
ivec2 tilePlace()
{
    int columns = tileCounts().x;
    return ivec2(int(gl_WorkGroupID.x) % columns, int(gl_WorkGroupID.x) / columns);
}
/// Its first pixel.
ivec2 tileCorner() { return tilePlace() * int(kHistoryTileSide); }
ivec2 inTile(uint thread) { return ivec2(thread % kHistoryTileSide, thread / kHistoryTileSide); }
/// The block of a tile that a pixel of the tile is in.
uint blockInTile(ivec2 in_tile) { return uint(in_tile.y / int(kBlockSide)) * kTileBlocksAlong + uint(in_tile.x / int(kBlockSide)); }

#endif
