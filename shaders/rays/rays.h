// Rays and what they hit: the currency between every stage that traces.
// Shared by runtime/stages/*.cpp and shaders/**/*.comp.
#ifndef SHADERS_RAYS_H
#define SHADERS_RAYS_H
#include "format/gpu_scene.h"
#include "shaders/lib/queue.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kRaysGroupSize = 64u;

struct Ray
{
    vec3 origin;    // metres, world
    float t_max;    // metres along direction; hits beyond it do not count
    vec3 direction; // unit
    uint path;      // index of what the ray belongs to: a pixel, a path, a gather ray; also seeds its alpha decisions
};
GPU_SIZE(Ray, 32);

struct Hit
{
    float t;           // metres
    uint slot;         // index into BvhTriangles, kNone: nothing was hit
    vec2 barycentrics; // weights of v1 and v2
};
GPU_SIZE(Hit, 16);

struct ShadowRay // adds `radiance` to its path unless it is occluded
{
    Ray ray;
    vec3 radiance; // W/(m^2 sr), all weights included
    float unused;  // whole texels
};
GPU_SIZE(ShadowRay, 48);

struct QueueParams
{
    uint count;
};
GPU_SIZE(QueueParams, 4);

struct RaysParams
{
    uint seed; // of stochastic alpha, changes with the sample
};
GPU_SIZE(RaysParams, 4);

GPU_NAMESPACE_END
#endif
