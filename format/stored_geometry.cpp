#include "format/stored_geometry.h"

#include <algorithm>
#include <cmath>

namespace package
{
NodeBox rootBox(const gpu::vec3& bounds_min, const gpu::vec3& bounds_max)
{
    NodeBox box{{bounds_min.x, bounds_min.y, bounds_min.z}, {bounds_max.x, bounds_max.y, bounds_max.z}};
    float largest = 0;
    for (size_t axis = 0; axis < 3; ++axis)
        largest = std::max({largest, std::abs(box.low[axis]), std::abs(box.high[axis])});
    for (size_t axis = 0; axis < 3; ++axis)
    {
        box.low[axis] -= largest * 0x1p-20f; // a power of two: contraction changes nothing
        box.high[axis] += largest * 0x1p-20f;
    }
    return box;
}

uint16_t BoxSteps::toLow(float plane) const
{
    if (!(step_ > 0))
        return 0;
    auto steps = uint32_t(std::clamp((plane - low_) / step_, 0.0, kMostSteps));
    while (steps > 0 && low(steps) > plane)
        --steps;
    return uint16_t(steps);
}

uint16_t BoxSteps::toHigh(float plane) const
{
    if (!(step_ > 0))
        return 0;
    auto steps = uint32_t(std::clamp((high_ - plane) / step_, 0.0, kMostSteps));
    while (steps > 0 && high(steps) < plane)
        --steps;
    return uint16_t(steps);
}
} // namespace package
