#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/guide/guide.h"

// Makes the distribution that the next photons leave by. One group: each thread takes a run of cells, then the runs add up.

layout(local_size_x = kGuideLearnSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Groups { GuideGroups groups; };
layout(set = 1, binding = 1, scalar) buffer Scores { GuideScore scores[]; };
layout(set = 1, binding = 2, scalar) buffer Cumulative { float cumulative[]; };
#include "shaders/lib/guide.glsl"

const uint kRun = kGuideTotal / kGuideLearnSize;
shared float sums[kGuideLearnSize];

/// Sum over the runs before this thread's; sums[] then holds the sum of all in its last element.
float sumBefore(float own)
{
    uint t = gl_LocalInvocationID.x;
    sums[t] = own;
    for (uint step_ = 1u; step_ < kGuideLearnSize; step_ *= 2u)
    {
        barrier();
        float other = t >= step_ ? sums[t - step_] : 0.0;
        barrier();
        sums[t] += other;
    }
    barrier();
    return t > 0u ? sums[t - 1u] : 0.0;
}

void main()
{
    uint first = gl_LocalInvocationID.x * kRun;
    float own = 0.0;
    for (uint i = first; i < first + kRun; ++i)
    {
        scores[i].before = kGuideMemory * scores[i].before + float(scores[i].now);
        scores[i].now = 0u;
        own += scores[i].before;
    }
    sumBefore(own);
    float total = sums[kGuideLearnSize - 1u];
    barrier();
    float guided = total > 0.0 ? (1.0 - kGuideUnguided) / total : 0.0;
    float unguided = total > 0.0 ? kGuideUnguided : 1.0;
    own = 0.0;
    for (uint i = first; i < first + kRun; ++i)
        own += guided * scores[i].before + unguided * cellShare(i);
    float running = sumBefore(own);
    float whole = sums[kGuideLearnSize - 1u]; // 1 but for rounding
    for (uint i = first; i < first + kRun; ++i)
    {
        running += guided * scores[i].before + unguided * cellShare(i);
        cumulative[i] = i + 1u == kGuideTotal ? 1.0 : running / whole;
    }
}
