#include "compiler/bvh_tree.h"

#include <cmath>

namespace
{
float& component(gpu::vec3& v, uint32_t axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

float component(const gpu::vec3& v, uint32_t axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// Where the edge a-b meets the plane, as a box that surely contains the exact point.
Box crossing(const gpu::vec3& a, const gpu::vec3& b, uint32_t dimension, float position)
{
    const double t =
        (double(position) - component(a, dimension)) / (double(component(b, dimension)) - component(a, dimension));
    Box box;
    for (uint32_t axis = 0; axis < 3; ++axis)
    {
        const double exact = component(a, axis) + t * (double(component(b, axis)) - component(a, axis));
        const float infinity = std::numeric_limits<float>::infinity();
        component(box.low, axis) = std::nextafter(float(exact), -infinity);
        component(box.high, axis) = std::nextafter(float(exact), infinity);
    }
    return box;
}

Box intersect(const Box& a, const Box& b)
{
    return {max(a.low, b.low), min(a.high, b.high)};
}
} // namespace

void splitTriangleBox(std::span<const gpu::vec3, 3> v, const Box& box, uint32_t dimension, float position, Box& left,
                      Box& right)
{
    Box below;
    Box above;
    for (size_t i = 0; i < 3; ++i)
    {
        const gpu::vec3& a = v[i];
        const gpu::vec3& b = v[(i + 1) % 3];
        const float at_a = component(a, dimension);
        const float at_b = component(b, dimension);
        if (at_a <= position)
            below.grow(a);
        if (at_a >= position)
            above.grow(a);
        if ((at_a < position && position < at_b) || (at_b < position && position < at_a))
        {
            const Box point = crossing(a, b, dimension, position);
            below.grow(point);
            above.grow(point);
        }
    }
    component(below.high, dimension) = std::min(component(below.high, dimension), position);
    component(above.low, dimension) = std::max(component(above.low, dimension), position);
    left = intersect(below, box);
    right = intersect(above, box);
}
