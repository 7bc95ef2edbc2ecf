// Guided emission: towards the places where gathering rays end. The kernel declares `buffer Groups { GuideGroups groups; }`
// and `buffer Distribution { GuideDistribution distribution; }` before it includes this. Functions only.
#ifndef LIB_GUIDE_GLSL
#define LIB_GUIDE_GLSL
#include "shaders/guide/guide.h"

/// Fraction of the total power in a cell: the probability by which emitFrom() and emitInfinite() count.
float cellShare(uint cell) { return groups.shares[cell / kGuideCells] / float(kGuideCells); }

/// Probability of a cell by what was learned.
float cellProbability(uint cell)
{
    uint group = cell / kGuideCells;
    float of_group = distribution.groups[group] - (group > 0u ? distribution.groups[group - 1u] : 0.0);
    return of_group * (distribution.cells[cell] - (cell % kGuideCells > 0u ? distribution.cells[cell - 1u] : 0.0));
}

/// u within [low, high) as a number in [0, 1): what a choice has left of a random number.
float restOf(float u, float low, float high) { return clamp((u - low) / max(high - low, 1e-30), 0.0, 0.9999999); }

/// The cell that holds u in [0, 1) of the learned distribution; u becomes the place within it, uniform again.
uint pickCell(inout float u)
{
    uint group = 0u;
    while (group + 1u < kGuideGroups && u >= distribution.groups[group])
        ++group;
    u = restOf(u, group > 0u ? distribution.groups[group - 1u] : 0.0, distribution.groups[group]);
    uint start = group * kGuideCells, low = start, high = start + kGuideCells - 1u;
    while (low < high)
    {
        uint middle = (low + high) / 2u;
        if (u < distribution.cells[middle])
            high = middle;
        else
            low = middle + 1u;
    }
    u = restOf(u, low > start ? distribution.cells[low - 1u] : 0.0, distribution.cells[low]);
    return low;
}

#endif
