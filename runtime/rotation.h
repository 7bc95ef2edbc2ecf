// Rotations in double precision, as unit quaternions and as rotation vectors (axis times angle).
#pragma once
#include "format/vec3d.h"

#include <cmath>

struct Rotation
{
    double w = 1;
    Vec3d v; // axis * sin(angle / 2)

    /// First `b`, then `a`.
    friend Rotation operator*(const Rotation& a, const Rotation& b)
    {
        return {a.w * b.w - dot(a.v, b.v), b.v * a.w + a.v * b.w + cross(a.v, b.v)};
    }
    friend Rotation inverse(const Rotation& a) { return {a.w, a.v * -1}; }
    friend Vec3d rotate(const Rotation& a, const Vec3d& p) { return p + cross(a.v, cross(a.v, p) + p * a.w) * 2; }

    /// The rotation vector, of the shorter way round: radians, at most pi.
    friend Vec3d logarithm(const Rotation& a)
    {
        const double sine = length(a.v);
        if (sine == 0)
            return {};
        const double half = std::atan2(sine, std::fabs(a.w));
        return a.v * (std::copysign(2 * half, a.w) / sine);
    }
};

/// By |vector| radians about it.
inline Rotation exponential(const Vec3d& vector)
{
    const double angle = length(vector);
    if (angle == 0)
        return {};
    return {std::cos(angle / 2), vector * (std::sin(angle / 2) / angle)};
}

/// That turns the axes to three orthonormal vectors, right-handed (Shepperd: divides by the largest component).
inline Rotation rotationTo(const Vec3d& x, const Vec3d& y, const Vec3d& z)
{
    const double squares[4] = {1 + x.x + y.y + z.z, 1 + x.x - y.y - z.z, 1 - x.x + y.y - z.z, 1 - x.x - y.y + z.z};
    const auto part = [](double sum, double square) { return sum / (2 * std::sqrt(square)); };
    const size_t most = size_t(std::max_element(squares, squares + 4) - squares);
    const double own = std::sqrt(squares[most]) / 2;
    const double square = squares[most];
    if (most == 0)
        return {own, {part(y.z - z.y, square), part(z.x - x.z, square), part(x.y - y.x, square)}};
    if (most == 1)
        return {part(y.z - z.y, square), {own, part(y.x + x.y, square), part(z.x + x.z, square)}};
    if (most == 2)
        return {part(z.x - x.z, square), {part(y.x + x.y, square), own, part(z.y + y.z, square)}};
    return {part(x.y - y.x, square), {part(z.x + x.z, square), part(z.y + y.z, square), own}};
}
