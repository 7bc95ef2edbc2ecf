// How large the things in view are. Shared by runtime/stages/view_scale.cpp, lib/scene.glsl and shaders/view_scale/*.comp.
#ifndef SHADERS_VIEW_SCALE_H
#define SHADERS_VIEW_SCALE_H
#include "format/gpu_types.h"

GPU_NAMESPACE_BEGIN

// Where a length must come from somewhere, it comes from here and not from the size of the scene: what a room looks like does
// not depend on the plain that it stands on.
struct ViewScale
{
    vec3 focus;     // metres, world: the camera's position
    float distance; // metres: geometric mean over the picture of how far its shading points are from there
};
GPU_SIZE(ViewScale, 16);

struct MeasureParams
{
    vec3 focus;
    uint point_count;
    float fixed_distance; // metres; above 0: this in place of the mean
};
GPU_SIZE(MeasureParams, 20);

GPU_CONST uint kMeasureGroupSize = 256u;
GPU_CONST uint kMeasuredPoints = 64u; // by a thread at most: 16384 in all know the mean to 1 %

GPU_NAMESPACE_END
#endif
