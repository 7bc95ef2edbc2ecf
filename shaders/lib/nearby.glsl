// Samples that interpolate/nearby.comp found for a group of pixels. The kernel, whose groups have kRaysGroupSize threads that take pixels
// by tiledPixel(), declares `readonly buffer Nearby { uint nearby[]; }`, `readonly buffer NearbyCounts { uint nearby_counts[]; }` and what
// lib/sample.glsl wants. Functions and shared memory.
#ifndef LIB_NEARBY_GLSL
#define LIB_NEARBY_GLSL
#include "shaders/lib/sample.glsl"

shared SampleTexels nearby_samples[kNearbySamples];

/// All threads of the group take part. @return how many there are in nearby_samples; kNone: too many, each pixel has to search
uint loadNearby()
{
    uint group = gl_WorkGroupID.x, count = nearby_counts[group];
    if (count != kNone)
        for (uint k = gl_LocalInvocationID.x; k < count; k += kRaysGroupSize)
            nearby_samples[k] = loadSample(nearby[group * kNearbySamples + k]);
    barrier();
    return count;
}

#endif
