// Caustics. Shared by runtime/stages/caustics.cpp and shaders/caustics/*.comp.
#ifndef SHADERS_CAUSTICS_H
#define SHADERS_CAUSTICS_H
#include "shaders/photons/photons.h"
#include "shaders/primary/primary.h"
#include "shaders/tree/tree.h"

GPU_NAMESPACE_BEGIN

struct CausticsParams
{
    uint point_count;
    uint photon_count; // k of the density estimation
    float radius;      // of the density estimation at most: of the distance from the viewer
};
GPU_SIZE(CausticsParams, 12);

GPU_NAMESPACE_END
#endif
