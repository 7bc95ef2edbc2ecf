// Legs of photons' paths. Shared by runtime/stages/legs.cpp, gather.cpp and shaders/**.
#ifndef SHADERS_LEGS_H
#define SHADERS_LEGS_H
#include "shaders/photons/photons.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kLegCount = 1024u; // that are taken from a map
GPU_CONST uint kLegPaths = 8u;    // most paths that each is chosen from

struct Leg // light on its way from one surface to another
{
    vec3 from;   // metres: where it left, as seen from where it arrived
    uint normal; // octahedral: of the surface where it arrived, on that side
    vec3 to;     // metres: where it arrived
    float power; // luminance of all legs that it was chosen from; 0: there were none
};
GPU_SIZE(Leg, 32);

struct LegParams
{
    uint seed;
};
GPU_SIZE(LegParams, 4);

// The hemisphere over a sample in cells that rays by the cosine meet equally often: columns about the normal, and rows by the
// squared sine of the angle to it. Finer ones hold too few legs each.
GPU_CONST uint kAimColumns = 16u;
GPU_CONST uint kAimRows = 16u;
GPU_CONST uint kAimCells = kAimColumns * kAimRows; // column by column
GPU_CONST uint kAimWhole =
    1u << 24u;                   // what all legs together count, so that a sum does not depend on the order of threads
GPU_CONST float kAimMost = 0.5f; // most of the rays that legs aim: no ray weighs more than 1 / (1 - this)

GPU_NAMESPACE_END
#endif
