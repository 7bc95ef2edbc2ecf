// Caustics. Shared by runtime/stages/caustics.cpp and shaders/caustics/*.comp.
#ifndef SHADERS_CAUSTICS_H
#define SHADERS_CAUSTICS_H
#include "shaders/photons/photons.h"
#include "shaders/primary/primary.h"
#include "shaders/tree/tree.h"

GPU_NAMESPACE_BEGIN

struct SpreadPhotonsParams
{
    uint photon_count; // that a photon's light is spread over the disc of, about
    float radius;      // of a disc at most: of the distance from the viewer
    float pixel_angle; // radians from a pixel to the next; of an orthographic camera 0
    float pixel_side;  // metres, of an orthographic camera; else 0
    vec3 eye;
};
GPU_SIZE(SpreadPhotonsParams, 28);

struct CausticsParams
{
    uint point_count;
    uint width; // of the picture
};
GPU_SIZE(CausticsParams, 8);

GPU_NAMESPACE_END
#endif
