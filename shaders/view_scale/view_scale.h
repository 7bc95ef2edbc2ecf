// How large the things in view are. Shared by runtime/stages/view_scale.cpp, lib/scene.glsl and shaders/view_scale/*.comp.
#ifndef SHADERS_VIEW_SCALE_H
#define SHADERS_VIEW_SCALE_H
#include "format/gpu_types.h"

GPU_NAMESPACE_BEGIN

// Where a length must come from somewhere, it comes from here and not from the size of the scene: what a room looks like does
// not depend on the plain that it stands on.
struct ViewScale
{
    vec3 focus;     // metres, world: the camera's position, or where a camera of usual angle would see as much
    float distance; // metres: geometric mean of the shading points' distances from the camera, less that of the focus
};
GPU_SIZE(ViewScale, 16);

GPU_CONST uint kMeasureGroupSize = 256u;
GPU_CONST uint kMeasuredPoints = 64u; // by a thread at most: 16384 in all know the mean to 1 %

GPU_NAMESPACE_END
#endif
