// Smooth edges from the frames before. Shared by runtime/stages/antialias.cpp and shaders/antialias/*.
#ifndef SHADERS_ANTIALIAS_H
#define SHADERS_ANTIALIAS_H
#include "shaders/signals/signals.h"

GPU_NAMESPACE_BEGIN

struct AntialiasParams
{
    uint point_count;
    uint width;       // of the picture, pixels
    uint most_frames; // that a pixel may be the mean of
    uint highlights;  // 1: they move; Factors holds what the light in Direct has changed by since the last frame
    vec3 factor;      // by which the last picture is multiplied: by so much all light has changed since
};
GPU_SIZE(AntialiasParams, 28);

struct StandParams
{
    uint point_count;
    float scale;       // 1 / the number of frames in the sum
    float before;      // part that the moving picture still has, 0..1
    float most_frames; // that counts
};
GPU_SIZE(StandParams, 16);

GPU_NAMESPACE_END
#endif
