// A frame's light as signals: the data of a pixel for filters and histories. Shared by runtime/stages/{signals,history,denoise}.cpp
// and shaders/{signals,history,denoise}/*.
#ifndef SHADERS_SIGNALS_H
#define SHADERS_SIGNALS_H
#include "shaders/compose/compose.h"
#include "shaders/primary/primary.h"

GPU_NAMESPACE_BEGIN

struct SurfaceGuide // by which filters and histories recognise pixels of the same surface
{
    vec3 position; // metres, world
    uint normals;  // snorm 4 x 8: octahedral, the smooth one and the shading one
};
GPU_SIZE(SurfaceGuide, 16);

struct LightSignal // the light of a pixel, or weighted means over its surroundings and its past
{
    float sum;   // of the three channels of the light, W/(m^2 sr)
    uint chroma; // unorm 12, 12 and 8 bits: what part of it is red and green; the lobe's width in 0..1, 0: no lobe
    uvec2
        reflectance; // half 4: what part of even light the pixel would show; standard error of light over reflectance, < 0: unknown
};
GPU_SIZE(LightSignal, 16);

struct Motion
{
    vec2 from; // pixels: from where in the last picture to here what the pixel shows has moved; kNoMotion: unknown
    float
        distance; // metres along the way that the light came, from the eye to what the pixel shows; kInfinity: the sky
};
GPU_SIZE(Motion, 12);

GPU_CONST float kNoMotion = 1e30f;

struct FrameViews
{
    CameraParams now;
    CameraParams last;
};
GPU_SIZE(FrameViews, 176);

struct SignalParams
{
    uint point_count;
    float spread; // by which a ray is wider a metre on: ShadingPoint.width over the way from the eye; 0: parallel rays
    uint has_previous; // 1: FrameViews.last is that of the last frame
    uint terms;        // kLight* bits: of the light that is there
};
GPU_SIZE(SignalParams, 16);

GPU_NAMESPACE_END
#endif
