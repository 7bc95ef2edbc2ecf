// The sum of a frame's terms. Shared by runtime/stages/compose.cpp and shaders/compose/*.comp.
#ifndef SHADERS_COMPOSE_H
#define SHADERS_COMPOSE_H
#include "shaders/rays/rays.h"

GPU_NAMESPACE_BEGIN

struct ComposeParams
{
    uint pixel_count;
    uint point_count; // pixels, or twice as many: two points a pixel
    uint emission;    // 0: it is there, for camera rays find it, but not shown
};
GPU_SIZE(ComposeParams, 12);

GPU_NAMESPACE_END
#endif
