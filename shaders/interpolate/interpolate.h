// Interpolation of irradiance. Shared by runtime/stages/interpolate.cpp and shaders/interpolate/*.comp.
#ifndef SHADERS_INTERPOLATE_H
#define SHADERS_INTERPOLATE_H
#include "shaders/samples/samples.h"

GPU_NAMESPACE_BEGIN

struct SampleTexels // a Sample as interpolation reads it, three texels
{
    vec3 position;  // metres
    float support2; // square metres: the support's square
    vec3 normal;
    uint slot; // among the samples as they were gathered
    vec3 irradiance;
    float inverse_harmonic;
};
GPU_SIZE(SampleTexels, 48);

struct InterpolateParams
{
    uint point_count;
    uint width;  // of the picture, pixels
    float alpha; // of Eq. 2, per view distance, where no sample is accepted
    uint white;  // 1: as if every surface reflected all of it
};
GPU_SIZE(InterpolateParams, 16);

// Groups of so many pixels, tiles as far as the picture's width allows, search for samples together. Where a group's samples are more
// than as many, as where far things show behind near ones, its pixels search each for itself.
GPU_CONST uint kNearbySamples = 48u;
GPU_CONST uint kNearbyThreads = 8u; // that look at a group's points

struct NearbyParams
{
    uint point_count;
    uint width; // of the picture, pixels
    uint group_count;
};
GPU_SIZE(NearbyParams, 12);

struct InterpolateStatistics
{
    uint fallbacks; // pixels where no sample was accepted and the one of least variation was taken
    uint unlit;     // pixels without any sample
};
GPU_SIZE(InterpolateStatistics, 8);

GPU_NAMESPACE_END
#endif
