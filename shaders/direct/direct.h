// Direct light at the shading points. Shared by runtime/stages/direct.cpp and shaders/direct/*.comp.
#ifndef SHADERS_DIRECT_H
#define SHADERS_DIRECT_H
#include "shaders/direct/survey.h"

GPU_NAMESPACE_BEGIN

// Lights come in three groups, suns, skies and lamps: their powers do not compare, and a sun that is in the shade must not
// take the shadow ray of the sky. Each group gets its own. Lamps come in clusters: where there are several, tiles of pixels tell
// which are seen (survey.h).
struct DirectParams
{
    uint point_count;
    uint first_sample; // index of the pixel's sample
    uint seed;
    uint light_sample;       // which of light_sample_count this dispatch takes
    uint light_sample_count; // light samples a shading point and group; each contributes 1 / light_sample_count
    uint light_seed;         // the same for all dispatches of a group
    uint first_cluster;      // of the group
    uint cluster_count;
    uint candidate_count;     // light samples at most, one of which gets the shadow ray
    uint repeats;             // 1: those of one cluster differ, so that several of it help; 0: punctual lights
    uint traces_bsdf_samples; // 1: this dispatch also sends the BSDF-sampled rays
    uint pixel_count;
    uint width;        // of the picture, pixels
    vec3 emitters_low; // metres: what does not pass the box between them meets no emitter
    vec3 emitters_high;
};
GPU_SIZE(DirectParams, 76);

struct HighlightParams
{
    vec3 last_eye; // metres: where it was in the last frame
    uint pixel_count;
    uint width; // of the picture, pixels
    uint first_cluster;
    uint cluster_count; // of lamps
};
GPU_SIZE(HighlightParams, 28);

struct EmittedParams
{
    uint seed;
};
GPU_SIZE(EmittedParams, 4);

struct EmitterRay // the weight of a BSDF-sampled ray that ends on an emitter
{
    vec3 throughput; // f cos / pdf x the chain's throughput / light_sample_count
    float pdf;       // per steradian
};
GPU_SIZE(EmitterRay, 16);

GPU_NAMESPACE_END
#endif
