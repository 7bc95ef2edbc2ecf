// Sums without rounding. Shared by runtime/stages/exact_sum.cpp and shaders/resolve/add_exactly.comp.
#ifndef SHADERS_EXACT_SUM_H
#define SHADERS_EXACT_SUM_H
#include "shaders/rays/rays.h"

GPU_NAMESPACE_BEGIN

// A sum is a whole number of 128 bits, in units of 2^-64 W/(m^2 sr): adding is exact, so that its order does not show. What a
// sample has below a unit is left out, and what is above the largest sample cut off: each sample by itself.
GPU_CONST uint kExactWords = 4u;            // of a channel, the lowest first
GPU_CONST uint kExactUnitBits = 64u;        // a unit is 2^-kExactUnitBits
GPU_CONST uint kExactLargestExponent = 42u; // samples are below 2^43: 2^20 of them stay below 2^63

struct AddExactlyParams
{
    uint pixel_count;
    uint first; // samples of the pass, radiance[sample * pixel_count + pixel]
    uint last;  // is not added any more
};
GPU_SIZE(AddExactlyParams, 12);

GPU_NAMESPACE_END
#endif
