// Direct light at the shading points. Shared by runtime/stages/direct.cpp and shaders/direct/*.comp.
#ifndef SHADERS_DIRECT_H
#define SHADERS_DIRECT_H
#include "shaders/primary/primary.h"

GPU_NAMESPACE_BEGIN

struct DirectParams
{
    uint point_count;
    uint first_sample; // index of the pixel's sample
    uint seed;
    uint light_sample;       // which of light_sample_count this dispatch takes
    uint light_sample_count; // light samples a shading point; each contributes 1 / light_sample_count
};
GPU_SIZE(DirectParams, 20);

struct EmitterRay // what a BSDF-sampled ray is worth if it ends on an emitter
{
    vec3 throughput; // f cos / pdf x the chain's throughput / light_sample_count
    float pdf;       // per steradian
};
GPU_SIZE(EmitterRay, 16);

GPU_NAMESPACE_END
#endif
