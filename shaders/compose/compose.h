// The sum of a frame's terms. Shared by runtime/stages/compose.cpp and shaders/compose/*.comp.
#ifndef SHADERS_COMPOSE_H
#define SHADERS_COMPOSE_H
#include "shaders/rays/rays.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kLightEmission = 1u, kLightSharpDirect = 2u, kLightDirect = 4u, kLightIndirect = 8u, kLightGlossy = 16u,
               kLightCaustics = 32u;

struct ComposeParams
{
    uint pixel_count;
    uint point_count; // pixels, or twice as many: two points a pixel
    uint terms;       // kLight* bits: of which the picture is the sum
};
GPU_SIZE(ComposeParams, 12);

GPU_NAMESPACE_END
#endif
