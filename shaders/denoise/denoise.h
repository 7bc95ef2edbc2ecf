// Filtering light that each pixel knows from a random ray or two. Shared by runtime/stages/denoise.cpp and
// shaders/denoise/*.
#ifndef SHADERS_DENOISE_H
#define SHADERS_DENOISE_H
#include "shaders/signals/signals.h"

GPU_NAMESPACE_BEGIN

struct DenoiseParams
{
    uint point_count;
    uint width;        // of the picture, pixels
    uint step_;        // pixels between the places that a pass looks at; 1: the first pass
    float pixel_angle; // radians from a pixel to the next
};
GPU_SIZE(DenoiseParams, 16);

GPU_NAMESPACE_END
#endif
