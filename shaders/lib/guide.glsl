// Where photons leave for the places that gathering rays see. The kernel declares `buffer Groups { GuideGroups groups; }`
// and `buffer Cumulative { float cumulative[]; }` before it includes this. Functions only.
#ifndef LIB_GUIDE_GLSL
#define LIB_GUIDE_GLSL
#include "shaders/guide/guide.h"

const uint kGuideTotal = kGuideGroups * kGuideCells;

/// Probability of a cell by the lights' own distributions.
float cellShare(uint cell) { return groups.shares[cell / kGuideCells] / float(kGuideCells); }

/// Probability of a cell by what was learned.
float cellProbability(uint cell) { return cumulative[cell] - (cell > 0u ? cumulative[cell - 1u] : 0.0); }

/// The cell that holds u in [0, 1) of the learned distribution; u becomes the place within it, uniform again.
uint pickCell(inout float u)
{
    uint low = 0u, high = kGuideTotal - 1u;
    while (low < high)
    {
        uint middle = (low + high) / 2u;
        if (u < cumulative[middle])
            high = middle;
        else
            low = middle + 1u;
    }
    float start = low > 0u ? cumulative[low - 1u] : 0.0;
    u = clamp((u - start) / max(cumulative[low] - start, 1e-30), 0.0, 0.999999);
    return low;
}

#endif
