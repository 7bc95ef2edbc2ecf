// From accumulated radiance to display pixels. Shared by runtime/stages/resolve.cpp and shaders/resolve/*.comp.
#ifndef SHADERS_RESOLVE_H
#define SHADERS_RESOLVE_H
#include "shaders/lib/choice.h"
#include "shaders/rays/rays.h"

GPU_NAMESPACE_BEGIN

#define GPU_TONEMAPS(X) \
    X(kTonemapSrgb, 0u, "srgb") /* clamp, sRGB transfer */ \
    X(kTonemapAces, 1u, "aces") /* ACES-like filmic curve */ \
    X(kTonemapAgx, 2u, "agx")   /* AgX-like: desaturates towards white */
GPU_TONEMAPS(GPU_CHOICE_CONSTANT)

struct AccumulateParams
{
    uint pixel_count;
    uint sample_count; // radiance[sample * pixel_count + pixel]
};
GPU_SIZE(AccumulateParams, 8);

struct TonemapParams
{
    uint pixel_count;
    float scale;        // exposure / number of samples in the sum
    uint curve;         // kTonemap*
    uint swap_red_blue; // 1: the target is BGRA
};
GPU_SIZE(TonemapParams, 16);

GPU_NAMESPACE_END
#endif
