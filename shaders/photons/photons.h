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

struct PhotonStart // how a photon leaves its light
{
    vec3 origin;
    vec3 direction; // unit
    vec3 power;     // watts; 0: it does not
};
GPU_SIZE(PhotonStart, 36);

struct EmitParams
{
    uint path_count; // of the whole map: each photon carries its light's power / path_count
    uint first_path; // index of path 0 in the sequence of all frames
    uint seed;
    float aim;       // probability of being aimed at a caustic target
};
GPU_SIZE(EmitParams, 16);

struct TraceParams
{
    uint path_count;
    uint first_path;
    uint seed;
    uint event_limit;  // most surfaces met
    uint bounce_limit; // most photons a path may store
    uint caustic;      // 1: store only the first scattering vertex, and that only after a delta event
};
GPU_SIZE(TraceParams, 24);

// Pairs of a path's sampler: emission first, then the same number for every surface met.
GPU_CONST uint kEmitDimensions = 6u;
GPU_CONST uint kScatterDimensions = 2u;

GPU_NAMESPACE_END
#endif
