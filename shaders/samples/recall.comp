#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/samples/samples.h"

// Sets the last frame's samples aside and makes them the centres that the new points are classified to. One thread per
// old sample.

layout(local_size_x = kSamplesGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; }; // old samples
layout(set = 1, binding = 1, scalar) readonly buffer Samples { Sample samples[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Tenures { SampleTenure tenures[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer OldSamples { Sample old_samples[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer OldTenures { SampleTenure old_tenures[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer Spheres { vec4 spheres[]; };
layout(set = 1, binding = 6, scalar) writeonly buffer Sums { ClusterSums sums[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count)
        return;
    Sample s = samples[i];
    old_samples[i] = s;
    old_tenures[i] = tenures[i];
    spheres[i] = vec4(s.position, 0.0);
    sums[i] = ClusterSums(uvec3(0u), 0u, uvec3(0u), 0u, 0xffffffffu, 0u, kNone);
}
