// Indirect light in rough mirrors. Shared by runtime/stages/glossy.cpp and shaders/glossy/*.comp.
#ifndef SHADERS_GLOSSY_H
#define SHADERS_GLOSSY_H
#include "shaders/gather/gather.h"

GPU_NAMESPACE_BEGIN

struct GlossyParams
{
    uint point_count;
    uint width;        // of the picture, pixels
    uint first_sample; // index of the pixel's sample
    uint seed;
    uint depth_limit;         // most specular events of a path
    uint shared_;             // 1: Shares holds the fraction of the light that is there already
    float roulette_threshold; // Russian-roulette threshold: from here on every pixel sends its ray
};
GPU_SIZE(GlossyParams, 28);

GPU_NAMESPACE_END
#endif
