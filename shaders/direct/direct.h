// Direct light at the shading points. Shared by runtime/stages/direct.cpp and shaders/direct/*.comp.
#ifndef SHADERS_DIRECT_H
#define SHADERS_DIRECT_H
#include "shaders/primary/primary.h"

GPU_NAMESPACE_BEGIN

// Lights come in three groups, suns, skies and lamps: their powers do not compare, and a sun that is in the shade must not
// take the shadow ray of the sky. Each group gets its own.
struct LightPick // Walker's alias method within a group
{
    uint light; // taken where a second uniform number < threshold
    float threshold;
    uint otherwise; // light taken else
};
GPU_SIZE(LightPick, 12);

struct DirectParams
{
    uint point_count;
    uint first_sample; // index of the pixel's sample
    uint seed;
    uint light_sample;       // which of light_sample_count this dispatch takes
    uint light_sample_count; // light samples a shading point and group; each contributes 1 / light_sample_count
    uint light_seed;         // the same for all dispatches of a group
    uint first_pick;         // the group's part of the picks
    uint pick_count;
    float share;              // of the group, of all lights' pmf
    uint candidate_count;     // light samples of which one gets the shadow ray
    uint traces_bsdf_samples; // 1: this dispatch also sends the BSDF-sampled rays
};
GPU_SIZE(DirectParams, 44);

struct EmittedParams
{
    uint seed;
    float environment_density; // of one candidate's direction, over the density of all lights together
    float local_density;
};
GPU_SIZE(EmittedParams, 12);

struct EmitterRay // the weight of a BSDF-sampled ray that ends on an emitter
{
    vec3 throughput; // f cos / pdf x the chain's throughput / light_sample_count
    float pdf;       // per steradian
};
GPU_SIZE(EmitterRay, 16);

GPU_NAMESPACE_END
#endif
