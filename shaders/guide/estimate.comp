#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/guide/guide.h"

// Sums by cell the squares of what its paths give the picture. n paths of a cell that is chosen with probability q bring values
// around c / (n q): their squares times q, summed over n = q N paths, estimate c^2 / N whatever q is, and the sum of all values has the
// least variance where q is proportional to c, the root of the mean square. A path that seldom arrives in view counts by the root of
// its probability, as the bright photons of such paths are what is seen as noise. One thread per path.

layout(local_size_x = kGuideGroupSize) in;
layout(push_constant, scalar) uniform Params { EstimateParams params; };

layout(set = 1, binding = 6, scalar) readonly buffer Groups { GuideGroups groups; }; // not read
layout(set = 1, binding = 0, scalar) readonly buffer Distribution { GuideDistribution distribution; };
layout(set = 1, binding = 1, scalar) readonly buffer Cells { uint cells[]; }; // by path; kNone: nothing left
layout(set = 1, binding = 2, scalar) readonly buffer Store { PhotonStore store; };
layout(set = 1, binding = 3, scalar) readonly buffer Values { float values[]; }; // by path
layout(set = 1, binding = 4, scalar) readonly buffer Largest { float largest; };
layout(set = 1, binding = 5, scalar) buffer Estimates { GuideEstimate estimates[]; };
#include "shaders/lib/guide.glsl"

void main()
{
    uint path = gl_GlobalInvocationID.x;
    if (path >= store.path_count || cells[path] == kNone || values[path] == 0.0)
        return;
    uint cell = cells[path];
    float amount = square(values[path] / largest) * cellProbability(cell) * params.scale;
    // Integers, so that the sum does not depend on the order of threads; 64 bits, because a rare path may be 1000 times the others.
    const float kHigh = 4294967296.0;
    uint high = uint(amount / kHigh), low = uint(amount - float(high) * kHigh);
    uint before = atomicAdd(estimates[cell].low, low);
    high += uint(before + low < before);
    if (high > 0u)
        atomicAdd(estimates[cell].high, high);
}
