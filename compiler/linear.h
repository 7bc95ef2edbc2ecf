// Linear algebra of importing: unit vectors that always exist; affine transforms are in format/transform.h.
#pragma once
#include "compiler/vector_math.h"
#include "format/transform.h"

#include <cmath>

inline bool isFinite(gpu::vec3 a)
{
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// `a` at unit length, or `fallback` where it has none (zero, NaN, infinite).
inline gpu::vec3 normalizeOr(gpu::vec3 a, gpu::vec3 fallback)
{
    return directionOr(toDouble(a), fallback);
}

/// Some unit vector orthogonal to the unit vector `n`.
inline gpu::vec3 anyOrthogonal(gpu::vec3 n)
{
    const gpu::vec3 axis = std::fabs(n.x) < 0.6f ? gpu::vec3{1, 0, 0} : gpu::vec3{0, 1, 0};
    return normalizeOr(cross(n, axis), {0, 0, 1});
}
