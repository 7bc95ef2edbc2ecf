// Temporal histories of pixels' light. Shared by runtime/stages/history.cpp and shaders/history/*.
#ifndef SHADERS_HISTORY_H
#define SHADERS_HISTORY_H
#include "shaders/signals/signals.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kMostHistoryFrames = 63u; // that a HistoryLight can count

struct HistoryLight // mean of the light over reflectance in the frames before
{
    uvec2 words; // three mantissas of 14 bits, exponent of 8, frames of 6, spread of 8; see history/blend.comp
};
GPU_SIZE(HistoryLight, 8);

struct PixelHistory // by term; two texels
{
    HistoryLight direct;
    HistoryLight indirect;
    HistoryLight glossy;
    HistoryLight caustics;
};
GPU_SIZE(PixelHistory, 32);

struct LightPair // a pixel's light over reflectance, in this frame and in the mean of those before
{
    uvec2 words; // three mantissas of 8 bits and exponent of 8 each; 0: unknown
};
GPU_SIZE(LightPair, 8);

struct PixelPairs // by term; two texels
{
    LightPair direct;
    LightPair indirect;
    LightPair glossy;
    LightPair caustics;
};
GPU_SIZE(PixelPairs, 32);

GPU_CONST uint kHistoryTerms = 4u; // in the order of PixelHistory

// Tiles of the picture, of a group of threads each, where light has changed.
GPU_CONST uint kHistoryTileSide = 8u; // pixels
GPU_CONST uint kHistoryTileSize = 64u;

// One pixel of each block is compared with its surroundings; those of its block that show the same surface follow it. Of smaller
// blocks, of 2 pixels a side, moving LDR-FLIP where lights change is 0.076 for 0.078 in a hall of lamps, 0.134 for 0.135 in the atrium
// and equal in Sponza, and judging takes 0.28 ms for 0.08 (H200, 1920 x 1080).
GPU_CONST uint kBlockSide = 4u; // pixels
GPU_CONST uint kTileBlocksAlong = kHistoryTileSide / kBlockSide;
GPU_CONST uint kTileBlocks = kTileBlocksAlong * kTileBlocksAlong;
GPU_CONST uint kNoPixel = 0xFFFFFFFFu;

GPU_CONST uint kJudgeBlocks = 16u; // of a group of history/judge.comp, which has a thread for each term of each
GPU_CONST uint kJudgeSize = kJudgeBlocks * kHistoryTerms;

struct HistoryBlock // tile after tile; within one row by row
{
    uint pixel;     // that is compared, the nearest to the centre that shows a surface; kNoPixel: none does
    uvec4 memories; // by term, what it remembers: frames and spread, halves
};
GPU_SIZE(HistoryBlock, 20);

struct FollowedTerm // what becomes of the past of a block's pixels, by block and term: light -> gain x light + more
{
    uvec2 gain; // halves: gain, and the factor of the number of frames; that is less than 0 where nothing is known
    HistoryLight more;
};
GPU_SIZE(FollowedTerm, 16);

struct TermPairs // sums over pixels of one surface
{
    vec3 fresh; // light over reflectance in this frame
    vec3 past;  // and in the mean of those before
    float count;
};
GPU_SIZE(TermPairs, 28);

struct TilePairs // by term, over the pixels of a tile that show the same surface as the one nearest to its centre
{
    SurfaceGuide guide;
    TermPairs direct;
    TermPairs indirect;
    TermPairs glossy;
    TermPairs caustics;
};
GPU_SIZE(TilePairs, 128);

struct HistoryParams
{
    uint point_count;
    uint width;        // of the picture, pixels
    uint most_frames;  // in a mean; the next frame weighs 1 / (most_frames + 1)
    uint has_previous; // 1: there are histories to go on from
    uint seed;         // of rounding
    float pixel_angle; // radians from a pixel to the next; of an orthographic camera 0
    float pixel_side;  // metres, of an orthographic camera; else 0
    uint moves;        // 1: surfaces can move; Displacements holds one a pixel
    uint highlights; // 1: they move; Factors holds what direct light has changed by since the last frame, of each pixel
    vec3 least;      // where light has changed: the light is that of the last frame times a factor from here
    vec3 most;       // to here
};
GPU_SIZE(HistoryParams, 60);

GPU_NAMESPACE_END
#endif
