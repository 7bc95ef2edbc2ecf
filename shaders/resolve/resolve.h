// From accumulated radiance to display pixels. Shared by runtime/stages/resolve.cpp and shaders/resolve/*.comp.
#ifndef SHADERS_RESOLVE_H
#define SHADERS_RESOLVE_H
#include "shaders/rays/rays.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kTonemapSrgb = 0u; // clamp, sRGB transfer
GPU_CONST uint kTonemapAces = 1u; // ACES-like filmic curve
GPU_CONST uint kTonemapAgx = 2u;  // AgX-like: desaturates towards white

struct AccumulateParams
{
    uint pixel_count;
    uint sample_count; // radiance[sample * pixel_count + pixel]
};
GPU_SIZE(AccumulateParams, 8);

struct TonemapParams
{
    uint pixel_count;
    float scale;      // exposure / number of samples in the sum
    uint curve;       // kTonemap*
    uint swap_red_blue; // 1: the target is BGRA
};
GPU_SIZE(TonemapParams, 16);

GPU_NAMESPACE_END
#endif
