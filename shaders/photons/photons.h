// Photons: flux that travels from the lights. Shared by runtime/stages/photons.cpp, photon_map.cpp and shaders/**.
#ifndef SHADERS_PHOTONS_H
#define SHADERS_PHOTONS_H
#include "shaders/rays/rays.h"

GPU_NAMESPACE_BEGIN

struct Photon // where a photon met a surface that scatters
{
    vec3 position;  // metres, world
    uint direction; // octahedral unit vector, the way it travelled
    vec3 power;     // watts
    uint normal;    // octahedral unit vector: the geometric normal on the side it arrived at
};
GPU_SIZE(Photon, 32);

struct PhotonStart // a photon at its light
{
    vec3 origin;
    vec3 direction; // unit
    vec3 power;     // watts; 0: not emitted
};
GPU_SIZE(PhotonStart, 36);

struct EmitParams
{
    uint path_count; // of the whole map: each photon carries its light's power / path_count
    uint first_path; // index of path 0 in the sequence of all frames
    uint seed;
    float aim; // probability of being aimed at a caustic target
};
GPU_SIZE(EmitParams, 16);

struct PhotonTag // of a photon as it was appended: which one of which path
{
    uint path;
    uint number; // photons of the path before it
};
GPU_SIZE(PhotonTag, 8);

struct PhotonStore // what a map holds; made on the GPU
{
    uint path_count; // paths that are in it whole: 0 .. path_count - 1; fewer than were emitted where the store is full
    uint photon_count; // of those paths
};
GPU_SIZE(PhotonStore, 8);

struct TraceParams
{
    uint path_count;
    uint first_path;
    uint seed;
    uint capacity;     // photons that there is room for
    uint bounce_limit; // most photons a path may store
    uint caustic;      // 1: store only what met nothing but delta lobes, and one of them at least
    uint again;        // 1: only PhotonStore.path_count paths, straight to where they belong
};
GPU_SIZE(TraceParams, 28);

struct StoreParams
{
    uint path_count; // emitted
    uint capacity;
};
GPU_SIZE(StoreParams, 8);

// Russian roulette alone ends a path. Up to kFreeEvents surfaces it survives by what they reflect, at most kMostSurvival of
// the time, so that even white and mirrors come to an end; from there on every second path ends, and the others carry twice as
// much: at an albedo of 0.95 a thousandth of the light goes that far.
GPU_CONST uint kFreeEvents = 128u;
GPU_CONST float kMostSurvival = 0.98f;
GPU_CONST float kLateSurvival = 0.5f;

// Pairs of a path's sampler: emission first, then the same number for every surface met.
GPU_CONST uint kEmitDimensions = 6u;
GPU_CONST uint kScatterDimensions = 3u;

GPU_NAMESPACE_END
#endif
