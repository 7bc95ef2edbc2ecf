#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/cut/cut.h"

// E_min from the partial sums, and how many ids the tree has. One thread.

layout(local_size_x = 1) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Partials { PartialMean partials[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Threshold { CutThreshold threshold; };
layout(set = 1, binding = 3, scalar) writeonly buffer Ids { QueueSize ids; };

void main()
{
    float sum = 0.0;
    uint count = 0u;
    for (uint i = 0u; i < kPartialMeans; ++i)
    {
        sum += partials[i].sum;
        count += partials[i].count;
    }
    threshold = CutThreshold(sum / float(max(count, 1u)), 0u);
    uint id_count = size.count > 0u ? 2u * size.count - 1u : 0u;
    ids = queueSize(id_count);
}
