// Final gathering. Shared by runtime/stages/gather.cpp and shaders/gather/*.comp.
#ifndef SHADERS_GATHER_H
#define SHADERS_GATHER_H
#include "shaders/cut/cut.h"
#include "shaders/samples/samples.h"

GPU_NAMESPACE_BEGIN

struct GatherState // of a path between two vertices
{
    vec3 throughput; // of a sample's ray at first: the cosine's density over its own
    uint medium;
    uint specular; // mirrors and glass so far
};
GPU_SIZE(GatherState, 20);

struct Gathered // the result of one ray
{
    vec3 radiance;
    float nearness; // 1 / metres to its first surface, times the weight of a sample's ray; 0: none
};
GPU_SIZE(Gathered, 16);

struct PixelGatherParams
{
    uint first_point; // of the band of pixels that is gathered for
    uint point_count; // in it
    uint ray_count;   // of a pixel, in this frame
    uint first_ray;   // index of the first of them in the pixel's sequence
    uint seed;
};
GPU_SIZE(PixelGatherParams, 20);

struct GatherParams
{
    uint ray_count; // of a sample or pixel
    uint seed;
    uint depth_limit;  // most specular events of a path
    uint mode;         // kCut*
    uint photon_count; // k, in mode kCutKnn
    float radius;      // of density estimation at most, in mode kCutKnn: of the distance from the viewer
    uint leg_count;    // for aiming: all legs, or 0
};
GPU_SIZE(GatherParams, 28);

GPU_NAMESPACE_END
#endif
