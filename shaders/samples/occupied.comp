#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/samples/samples.h"

// Marks the clusters that have points. One thread per cluster.

layout(local_size_x = kSamplesGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Sums { ClusterSums sums[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Flags { uint flags[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < size.count)
        flags[i] = uint(sums[i].count > 0u);
}
