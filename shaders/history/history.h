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
GPU_CONST uint kTileBlocksAlong = 4u; // blocks of 2 x 2 pixels along a side
GPU_CONST uint kTileBlocks = 16u;

// One pixel of each block is compared with its surroundings; those of its block that show the same surface follow it. A
// thread works on one term of one block, so that a tile takes as many threads as it has pixels.
GPU_CONST uint kNoPixel = 0xFFFFFFFFu;

// history/judge.comp works on squares of tiles: what surrounds them is loaded once for all, 1.9 pixels for each of their own. Tiles
// by themselves take 3.1, and a fifth longer on an H200.
GPU_CONST uint kJudgeTilesAlong = 2u;
GPU_CONST uint kJudgeSize = 256u; // threads

struct HistoryBlock // tile after tile; within one row by row
{
    uint pixel;     // of the picture, that is compared: the first that shows a surface; kNoPixel: none does
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
