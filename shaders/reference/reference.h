// The reference path tracer's state. Shared by runtime/stages/reference.cpp and shaders/reference/*.comp.
#ifndef SHADERS_REFERENCE_H
#define SHADERS_REFERENCE_H
#include "shaders/primary/primary.h"

GPU_NAMESPACE_BEGIN

struct PathState
{
    vec3 throughput;
    float pdf;       // per steradian, with which the current direction was chosen; 0: delta or camera
    float travelled; // metres since the last scattering vertex (thin walls in between do not scatter)
    uint medium;     // material index of the absorbing medium the path is in, or kNone
    uint from_eye;   // 1: nothing but mirrors and glass since the camera
};
GPU_SIZE(PathState, 28);

struct ShadeParams
{
    uint depth; // scattering vertices before this one
    uint depth_limit;
    uint pixel_count;
    uint first_sample;
    uint seed;
};
GPU_SIZE(ShadeParams, 20);

GPU_NAMESPACE_END
#endif
