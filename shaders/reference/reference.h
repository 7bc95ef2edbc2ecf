// The reference path tracer's state. Shared by runtime/stages/reference.cpp and shaders/reference/*.comp.
#ifndef SHADERS_REFERENCE_H
#define SHADERS_REFERENCE_H
#include "shaders/primary/primary.h"

GPU_NAMESPACE_BEGIN

// What a path has met so far; it only ever grows. x and the lobes as in lib/terms.h.
GPU_CONST uint kStageEye = 0u;      // nothing but mirrors and glass: x is still to come
GPU_CONST uint kStageLeft = 1u;     // x, and nothing since
GPU_CONST uint kStageSpecular = 2u; // mirrors and glass since x
GPU_CONST uint kStageDeep = 3u;     // another vertex since x that is not delta

GPU_CONST uint kLobeDiffuse = 1u;
GPU_CONST uint kLobeSpecular = 2u;
GPU_CONST uint kLobesBoth = 3u;

struct PathState
{
    vec3 throughput;
    vec3 share;      // of the throughput, per channel: what went through the lobes of x that count
    float pdf;       // per steradian, with which the current direction was chosen; 0: delta or camera
    float travelled; // metres since the last scattering vertex (thin walls in between do not scatter)
    uint medium;     // material index of the absorbing medium the path is in, or kNone
    uint stage;      // kStage*
};
GPU_SIZE(PathState, 40);

struct ShadeParams
{
    uint depth; // scattering vertices before this one
    uint depth_limit;
    uint pixel_count;
    uint first_sample;
    uint seed;
    uint stages;      // bits 1 << kStage*: light counts that a path finds in one of them
    uint lobes;       // bits kLobe*: of x, through which it counts
    uint first_stage; // kStage*: of all paths at depth 0
};
GPU_SIZE(ShadeParams, 32);

GPU_NAMESPACE_END
#endif
