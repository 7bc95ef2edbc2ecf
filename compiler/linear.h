// Linear algebra of importing: unit vectors that always exist, and affine transforms in double precision.
#pragma once
#include "compiler/vector_math.h"

#include <array>
#include <cmath>

inline bool isFinite(gpu::vec3 a)
{
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// `a` at unit length, or `fallback` where it has none (zero, NaN, infinite).
inline gpu::vec3 normalizeOr(gpu::vec3 a, gpu::vec3 fallback)
{
    const double l = std::sqrt(double(a.x) * a.x + double(a.y) * a.y + double(a.z) * a.z);
    if (!(l > 1e-30) || !std::isfinite(l))
        return fallback;
    return {float(a.x / l), float(a.y / l), float(a.z / l)};
}

/// Some unit vector orthogonal to the unit vector `n`.
inline gpu::vec3 anyOrthogonal(gpu::vec3 n)
{
    const gpu::vec3 axis = std::fabs(n.x) < 0.6f ? gpu::vec3{1, 0, 0} : gpu::vec3{0, 1, 0};
    return normalizeOr(cross(n, axis), {0, 0, 1});
}

/// Affine transform in double precision: column-major 3x4, the last row being (0 0 0 1).
struct Transform
{
    std::array<double, 9> linear{1, 0, 0, 0, 1, 0, 0, 0, 1}; // column-major
    std::array<double, 3> translation{0, 0, 0};

    gpu::vec3 vector(gpu::vec3 v) const
    {
        return {float(linear[0] * v.x + linear[3] * v.y + linear[6] * v.z),
                float(linear[1] * v.x + linear[4] * v.y + linear[7] * v.z),
                float(linear[2] * v.x + linear[5] * v.y + linear[8] * v.z)};
    }
    gpu::vec3 point(gpu::vec3 p) const
    {
        return {float(linear[0] * p.x + linear[3] * p.y + linear[6] * p.z + translation[0]),
                float(linear[1] * p.x + linear[4] * p.y + linear[7] * p.z + translation[1]),
                float(linear[2] * p.x + linear[5] * p.y + linear[8] * p.z + translation[2])};
    }
    double determinant() const
    {
        const auto& m = linear;
        return m[0] * (m[4] * m[8] - m[7] * m[5]) - m[3] * (m[1] * m[8] - m[7] * m[2]) +
               m[6] * (m[1] * m[5] - m[4] * m[2]);
    }
    /// For normals: the inverse transpose, but for a positive factor (so that it exists for singular matrices too).
    gpu::vec3 normal(gpu::vec3 n) const
    {
        const auto& m = linear;
        const double sign = determinant() < 0 ? -1 : 1;
        const double x =
            (m[4] * m[8] - m[5] * m[7]) * n.x + (m[2] * m[7] - m[1] * m[8]) * n.y + (m[1] * m[5] - m[2] * m[4]) * n.z;
        const double y =
            (m[5] * m[6] - m[3] * m[8]) * n.x + (m[0] * m[8] - m[2] * m[6]) * n.y + (m[2] * m[3] - m[0] * m[5]) * n.z;
        const double z =
            (m[3] * m[7] - m[4] * m[6]) * n.x + (m[1] * m[6] - m[0] * m[7]) * n.y + (m[0] * m[4] - m[1] * m[3]) * n.z;
        const double l = std::sqrt(x * x + y * y + z * z) * sign;
        return l == 0 ? gpu::vec3{0, 0, 0} : gpu::vec3{float(x / l), float(y / l), float(z / l)};
    }
};

/// a after b: (a * b)(p) = a(b(p))
inline Transform operator*(const Transform& a, const Transform& b)
{
    Transform c;
    for (int column = 0; column < 4; ++column)
    {
        const double* v = column < 3 ? &b.linear[3 * column] : b.translation.data();
        for (int row = 0; row < 3; ++row)
        {
            const double value = a.linear[row] * v[0] + a.linear[3 + row] * v[1] + a.linear[6 + row] * v[2];
            if (column < 3)
                c.linear[3 * column + row] = value;
            else
                c.translation[row] = value + a.translation[row];
        }
    }
    return c;
}
