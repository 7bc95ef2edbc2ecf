#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/gather/gather.h"
#include "shaders/gather/harmonics.h"

// Kept samples keep their light by direction. One thread per kept sample.

layout(local_size_x = kSamplesGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer KeptSize { QueueSize kept_size; };
layout(set = 1, binding = 1, scalar) readonly buffer Kept { uint kept[]; }; // their indices in the last frame
layout(set = 1, binding = 2, scalar) readonly buffer OldHarmonics { SampleHarmonics old_harmonics[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer Harmonics { SampleHarmonics harmonics[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < kept_size.count)
        harmonics[i] = old_harmonics[kept[i]];
}
