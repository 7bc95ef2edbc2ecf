// Filtering light that each pixel knows from a random ray or two. Shared by runtime/stages/denoise.cpp and
// shaders/denoise/*.
#ifndef SHADERS_DENOISE_H
#define SHADERS_DENOISE_H
#include "shaders/primary/primary.h"

GPU_NAMESPACE_BEGIN

struct DenoiseGuide // what tells whether two pixels see light of the same kind
{
    vec3 position; // metres, world
    uint normals;  // snorm 4 x 8: octahedral, the smooth one and the shading one
};
GPU_SIZE(DenoiseGuide, 16);

struct DenoiseSignal // weighted means over a pixel's surroundings
{
    float sum;         // of the three channels of the light, W/(m^2 sr)
    uint chroma;       // unorm 12, 12 and 8 bits: what part of it is red and green; the lobe's width in 0..1, 0: no lobe
    uvec2 reflectance; // half 4: what part of even light the pixel would show; standard error of light over reflectance
};
GPU_SIZE(DenoiseSignal, 16);

struct DenoiseParams
{
    uint point_count;
    uint width;        // of the picture, pixels
    uint step_;        // pixels between the places that a pass looks at; 1: the first pass
    float pixel_angle; // radians from a pixel to the next
    uint glossy;       // 1: light of specular lobes alone
};
GPU_SIZE(DenoiseParams, 20);

GPU_NAMESPACE_END
#endif
