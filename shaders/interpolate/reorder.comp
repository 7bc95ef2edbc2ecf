#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/interpolate/interpolate.h"
#include "shaders/lib/math.glsl"

// Samples in the order of their tree, unpacked. One thread per sample.

layout(local_size_x = kSamplesGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Order { uint order[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Samples { Sample samples[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer Sorted { SampleTexels sorted[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count)
        return;
    uint slot = order[i];
    Sample s = samples[slot];
    sorted[i] = SampleTexels(s.position, square(s.support), unpackNormal(s.normal), slot, s.irradiance, 1.0 / s.harmonic_mean_distance);
}
