// Layers of a picture: its terms and what the camera sees first. Shared by runtime/stages/layers.cpp and shaders/layers/*.
#ifndef SHADERS_LAYERS_H
#define SHADERS_LAYERS_H
#include "shaders/signals/signals.h"

GPU_NAMESPACE_BEGIN

struct LayerSums // over the frames of a picture, but for the depth
{
    vec3 emission; // W/(m^2 sr), as the other terms
    vec3 direct;
    vec3 indirect;
    vec3 glossy;
    vec3 caustics;
    vec3 albedo; // part of even light that the first point shows
    vec3 normal; // unit, world; with the normal map
    float depth; // metres along the way that the light comes, of the last frame; kSkyDepth: the sky
    vec2 motion; // pixels, from here to where that was in the picture before, of the last frame
};
GPU_SIZE(LayerSums, 96);

GPU_CONST float kSkyDepth = 3e38f;

struct LayersParams
{
    uint pixel_count;
    uint point_count; // pixels, or twice as many: two points a pixel
    uint terms;       // kLight* bits: that the frame made
    uint adds;        // 0: the first frame of a picture
    float spread;     // ShadingPoint.width over the way from the eye; 0: parallel rays
    vec3 eye;         // the camera's position
    vec3 forward;     // unit
    uint has_last;    // 1: FrameViews.last is that of the picture before
};
GPU_SIZE(LayersParams, 48);

GPU_NAMESPACE_END
#endif
