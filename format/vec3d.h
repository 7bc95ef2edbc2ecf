// Points and vectors in double precision: what positions are computed in until they are small enough for floats.
#pragma once
#include "format/gpu_types.h"

#include <algorithm>
#include <cmath>

struct Vec3d // its functions are friends, so that braced lists of floats never convert to it
{
    double x = 0, y = 0, z = 0;

    friend Vec3d operator+(const Vec3d& a, const Vec3d& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vec3d operator-(const Vec3d& a, const Vec3d& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vec3d operator*(const Vec3d& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
    friend bool operator==(const Vec3d& a, const Vec3d& b) = default;
    friend double dot(const Vec3d& a, const Vec3d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    friend double length(const Vec3d& a) { return std::sqrt(dot(a, a)); }
    friend double largest(const Vec3d& a) { return std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)}); }
    friend Vec3d cross(const Vec3d& a, const Vec3d& b)
    {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    friend bool isFinite(const Vec3d& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

    /// `a` at unit length, whatever its length; 0 where it has no direction (zero, NaN, infinite).
    friend Vec3d unitOrZero(const Vec3d& a)
    {
        const double scale = largest(a);
        if (!isFinite(a) || scale == 0)
            return {};
        const Vec3d scaled{a.x / scale, a.y / scale, a.z / scale};
        return scaled * (1 / length(scaled));
    }
    friend gpu::vec3 toFloat(const Vec3d& a) { return {float(a.x), float(a.y), float(a.z)}; }
};

/// Rec. 709 luminance of linear RGB.
inline float luminance(const gpu::vec3& rgb)
{
    return 0.2126f * rgb.x + 0.7152f * rgb.y + 0.0722f * rgb.z;
}

inline Vec3d toDouble(gpu::vec3 a)
{
    return {a.x, a.y, a.z};
}

/// The unit vector of `a`, or `fallback` where that has no direction.
inline gpu::vec3 directionOr(const Vec3d& a, gpu::vec3 fallback)
{
    const Vec3d unit = unitOrZero(a);
    return unit == Vec3d{} ? fallback : toFloat(unit);
}
