// Camera rays and the specular chains that follow them, up to the first surface that scatters.
// Shared by runtime/stages/primary.cpp, direct.cpp, reference.cpp and shaders/**.
#ifndef SHADERS_PRIMARY_H
#define SHADERS_PRIMARY_H
#include "shaders/rays/rays.h"

GPU_NAMESPACE_BEGIN

struct CameraParams // a ray through image position (x, y) in [-1,1]^2, y up, goes along forward + x right + y up
{
    vec3 position;
    vec3 right; // scaled: half the image's width at distance 1 (perspective) or in metres (orthographic)
    vec3 up;    // likewise half its height
    vec3 forward;
    uint width; // pixels
    uint height;
    uint orthographic; // 1: parallel rays from position + x right + y up
    float near_plane;  // metres along forward to the plane that rays start in
    float far_plane;   // metres along forward to the plane that they end in; 0: they do not
    uint sample_count; // rays a pixel in this dispatch; path = sample * width * height + pixel
    uint first_sample; // index of the first of them in the pixel's sequence
    uint seed;
    vec2 jitter; // of every pixel's ray within the pixel, between 0 and 1; 0: each pixel's own, by its sampler
};
GPU_SIZE(CameraParams, 88);

struct ChainParams
{
    CameraParams camera; // with sample_count 1
    uint depth_limit;    // most specular events in a chain
    uint splits;         // 1: mirrored light goes on to a second point of its own, [pixel_count + pixel]
    float width;         // metres, of a camera ray at the eye
    float spread;        // by which it widens a metre
    uint trace_seed;     // of stochastic alpha, changes with the sample
};
GPU_SIZE(ChainParams, 108);

struct ShadingPoint // where a pixel's light is to be found: first vertex after E S* that scatters
{
    vec3 position;   // metres, world
    uint slot;       // index into BvhTriangles, kNone: background, finished
    vec3 direction;  // unit, of the ray that arrived
    uint depth;      // specular events before it
    vec3 throughput; // of the chain, 1/probability of its choices included
    vec2 barycentrics;
    float width;     // metres, across the chain's last ray: of what textures show at once
    float back;      // metres, back along that ray to where rays leave: off the surface by more than rounding
    uint mirror;     // in which it is seen: kNoMirror, the packed normal of the only one, kManyMirrors
    vec3 base_color; // of the surface, textures applied, as the next: so that nobody samples them again
    uint finish;     // roughness and metallic, see lib/finish.glsl
};
GPU_SIZE(ShadingPoint, 80);

GPU_CONST uint kNoMirror = 0x80008000u, kManyMirrors = 0x80000000u; // not among packed normals

struct DiffusePoint // what a shading point shows of the irradiance that falls on it, so that nobody works it out again
{
    vec3 position;    // metres, world; off the surface by what rounding needs, so that rays may start there
    vec2 normal;      // octahedral; the smooth one, before the normal map, on the viewer's side
    vec3 reflectance; // towards the viewer: throughput x diffuse reflectance x what even light
        // gives the bent normal of that which it gives the smooth one; 0: background, or nothing diffuse there
};
GPU_SIZE(DiffusePoint, 32);

// Pairs of the pixel's sampler, so that no two uses share one: camera first, then the same number for every vertex.
GPU_CONST uint kCameraDimensions = 1u;
GPU_CONST uint kVertexDimensions = 8u;

GPU_NAMESPACE_END
#endif
