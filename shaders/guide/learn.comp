#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/guide/guide.h"

// Computes the emission distribution of the next photons: cells in proportion to the root of the mean square of what their paths
// give the picture (guide/fade.comp), half of it spread over the cells around. A cell that a window's edge crosses is hit by few
// paths, which are very bright until it is learned; beside a bright cell it is expected to be one. One group: each thread takes a
// run of cells of one group, then runs add up in order.

layout(local_size_x = kGuideLearnSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Groups { GuideGroups groups; };
layout(set = 1, binding = 1, scalar) readonly buffer Roots { float roots[]; }; // of the cells' estimates
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

/// The root of the estimate; of a light with places of its own, half of it from the 3 x 3 cells around by 1 2 1.
float target(uint i)
{
    float own = roots[i];
    uint group = i / kGuideCells;
    if (group >= kGuideInfiniteLights)
        return own;
    ivec2 at = ivec2(i % kGuideSide, i % kGuideCells / kGuideSide);
    float around = 0.0;
    for (int y = max(at.y - 1, 0); y <= min(at.y + 1, int(kGuideSide) - 1); ++y)
        for (int x = max(at.x - 1, 0); x <= min(at.x + 1, int(kGuideSide) - 1); ++x)
        {
            float weight = (x == at.x ? 2.0 : 1.0) * (y == at.y ? 2.0 : 1.0) / 16.0;
            around += weight * roots[group * kGuideCells + uint(y) * kGuideSide + uint(x)];
        }
    return mix(own, around, kGuideSpread);
}

void main()
{
    uint run = gl_LocalInvocationID.x, first = run * kRun, group = run / kGroupRuns;
    float own = 0.0, targets[kRun];
    for (uint i = 0u; i < kRun; ++i)
    {
        targets[i] = groups.shares[group] > 0.0 ? target(first + i) : 0.0;
        own += targets[i];
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
        running += guided * targets[i - first] + even;
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
