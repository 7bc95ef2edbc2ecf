#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/guide/guide.h"

// Computes the emission distribution of the next photons. One group: each thread takes a run of cells of one group, then runs
// add up in order.

layout(local_size_x = kGuideLearnSize) in;
layout(push_constant, scalar) uniform Params { LearnParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Groups { GuideGroups groups; };
layout(set = 1, binding = 1, scalar) buffer Estimates { GuideEstimate estimates[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Distribution { GuideDistribution distribution; };

const uint kRun = kGuideTotal / kGuideLearnSize;    // cells
const uint kGroupRuns = kGuideCells / kRun;
shared float sums[kGuideLearnSize]; // of the runs' estimates

float sumOfRuns(uint first, uint end)
{
    float sum = 0.0;
    for (uint i = first; i < end; ++i)
        sum += sums[i];
    return sum;
}

void main()
{
    uint run = gl_LocalInvocationID.x, first = run * kRun, group = run / kGroupRuns;
    float own = 0.0;
    for (uint i = first; i < first + kRun; ++i)
    {
        estimates[i].before = params.memory * estimates[i].before + float(estimates[i].now);
        estimates[i].now = 0u;
        own += estimates[i].before;
    }
    sums[run] = own;
    barrier();
    float total = sumOfRuns(0u, kGuideLearnSize);
    float guided = total > 0.0 ? (1.0 - kGuideUnguided) / total : 0.0;
    float unguided = total > 0.0 ? kGuideUnguided : 1.0;

    // Probabilities of this group's cells in proportion to these weights.
    float even = unguided * groups.unlearned[group] / float(kGuideCells);
    float of_group = guided * sumOfRuns(group * kGroupRuns, (group + 1u) * kGroupRuns) + unguided * groups.unlearned[group];
    float running = guided * sumOfRuns(group * kGroupRuns, run) + even * float((run % kGroupRuns) * kRun);
    for (uint i = first; i < first + kRun; ++i)
    {
        running += guided * estimates[i].before + even;
        bool last = (i + 1u) % kGuideCells == 0u;
        distribution.cells[i] = last || of_group == 0.0 ? 1.0 : running / of_group;
    }
    if (run >= kGuideGroups)
        return;
    float before = guided * sumOfRuns(0u, (run + 1u) * kGroupRuns); // of this thread as a group
    for (uint g = 0u; g <= run; ++g)
        before += unguided * groups.unlearned[g];
    distribution.groups[run] = run + 1u == kGuideGroups ? 1.0 : before;
}
