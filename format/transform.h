// Affine transforms in double precision, as glTF composes them.
#pragma once
#include "format/vec3d.h"

#include <array>

/// Column-major 3x4, the last row being (0 0 0 1).
struct Transform
{
    std::array<double, 9> linear{1, 0, 0, 0, 1, 0, 0, 0, 1}; // column-major
    std::array<double, 3> translation{0, 0, 0};

    Vec3d vector(const Vec3d& v) const
    {
        return {linear[0] * v.x + linear[3] * v.y + linear[6] * v.z,
                linear[1] * v.x + linear[4] * v.y + linear[7] * v.z,
                linear[2] * v.x + linear[5] * v.y + linear[8] * v.z};
    }
    Vec3d point(const Vec3d& p) const
    {
        return {linear[0] * p.x + linear[3] * p.y + linear[6] * p.z + translation[0],
                linear[1] * p.x + linear[4] * p.y + linear[7] * p.z + translation[1],
                linear[2] * p.x + linear[5] * p.y + linear[8] * p.z + translation[2]};
    }
    double determinant() const
    {
        const auto& m = linear;
        return m[0] * (m[4] * m[8] - m[7] * m[5]) - m[3] * (m[1] * m[8] - m[7] * m[2]) +
               m[6] * (m[1] * m[5] - m[4] * m[2]);
    }
    /// For normals: the inverse transpose, but for a positive factor (so that it exists for singular matrices too).
    Vec3d normal(const Vec3d& n) const
    {
        const auto& m = linear;
        const double sign = determinant() < 0 ? -1 : 1;
        return Vec3d{(m[4] * m[8] - m[5] * m[7]) * n.x + (m[2] * m[7] - m[1] * m[8]) * n.y +
                         (m[1] * m[5] - m[2] * m[4]) * n.z,
                     (m[5] * m[6] - m[3] * m[8]) * n.x + (m[0] * m[8] - m[2] * m[6]) * n.y +
                         (m[2] * m[3] - m[0] * m[5]) * n.z,
                     (m[3] * m[7] - m[4] * m[6]) * n.x + (m[1] * m[6] - m[0] * m[7]) * n.y +
                         (m[0] * m[4] - m[1] * m[3]) * n.z} *
               sign;
    }
};

/// a after b: (a * b)(p) = a(b(p))
inline Transform operator*(const Transform& a, const Transform& b)
{
    Transform c;
    for (size_t column = 0; column < 4; ++column)
    {
        const double* v = column < 3 ? &b.linear[3 * column] : b.translation.data();
        for (size_t row = 0; row < 3; ++row)
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

/// A node's translation, rotation and scale, the latter applied first.
Transform fromTranslationRotationScale(const std::array<double, 3>& translation,
                                       const std::array<double, 4>& rotation, // quaternion, normalised here
                                       const std::array<double, 3>& scale);
