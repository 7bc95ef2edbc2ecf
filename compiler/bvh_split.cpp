// The builder's innermost loop: called some ten million times for a large scene, so everything stays in registers.
#include "compiler/bvh_tree.h"

namespace
{
template <uint32_t kAxis>
float at(const gpu::vec3& v)
{
    return kAxis % 3 == 0 ? v.x : kAxis % 3 == 1 ? v.y : v.z;
}

/// Bounds across the plane, in the two axes other than kAxis, of the triangle's part on one side of it.
struct Extent
{
    float low_u = Box{}.low.x, low_v = Box{}.low.x;
    float high_u = Box{}.high.x, high_v = Box{}.high.x;

    void grow(float u, float v)
    {
        low_u = std::min(low_u, u);
        low_v = std::min(low_v, v);
        high_u = std::max(high_u, u);
        high_v = std::max(high_v, v);
    }
};

/// The box of one side: from..to along kAxis, `part` across it, never more than `box`.
template <uint32_t kAxis>
Box sideBox(const Box& box, const Extent& part, float from, float to)
{
    const auto place = [](float along, float u, float v) {
        return kAxis == 0 ? gpu::vec3{along, u, v} : kAxis == 1 ? gpu::vec3{v, along, u} : gpu::vec3{u, v, along};
    };
    return {max(box.low, place(from, part.low_u, part.low_v)), min(box.high, place(to, part.high_u, part.high_v))};
}

template <uint32_t kAxis>
void split(const std::array<gpu::vec3, 3>& corners, const Box& box, float position, Box& left, Box& right)
{
    Extent below;
    Extent above;
    const auto edge = [&](const gpu::vec3& a, const gpu::vec3& b)
    {
        const float at_a = at<kAxis>(a);
        const float at_b = at<kAxis>(b);
        const float u = at<kAxis + 1>(a);
        const float v = at<kAxis + 2>(a);
        if (at_a <= position)
            below.grow(u, v);
        if (at_a >= position)
            above.grow(u, v);
        if ((at_a < position) == (at_b < position) || at_a == position || at_b == position)
            return;
        // Double precision: the crossing is off by its own rounding only, which the padding of the leaves exceeds.
        const double t = (double(position) - at_a) / (double(at_b) - at_a);
        const auto cross_u = float(u + t * (double(at<kAxis + 1>(b)) - u));
        const auto cross_v = float(v + t * (double(at<kAxis + 2>(b)) - v));
        below.grow(cross_u, cross_v);
        above.grow(cross_u, cross_v);
    };
    edge(corners[0], corners[1]);
    edge(corners[1], corners[2]);
    edge(corners[2], corners[0]);
    left = sideBox<kAxis>(box, below, at<kAxis>(box.low), position);
    right = sideBox<kAxis>(box, above, position, at<kAxis>(box.high));
}
} // namespace

void splitTriangleBox(const std::array<gpu::vec3, 3>& corners, const Box& box, uint32_t axis, float position, Box& left,
                      Box& right)
{
    if (axis == 0)
        split<0>(corners, box, position, left, right);
    else if (axis == 1)
        split<1>(corners, box, position, left, right);
    else
        split<2>(corners, box, position, left, right);
}
