// Vectors in double precision, for the slow, obvious twins of kernels.
#pragma once
#include "format/gpu_types.h"

#include <algorithm>
#include <array>
#include <cmath>

struct Double3
{
    double x = 0, y = 0, z = 0;

    Double3() = default;
    Double3(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
    Double3(gpu::vec3 v) : x(v.x), y(v.y), z(v.z) {} // NOLINT: every float is a double
};

inline Double3 operator+(Double3 a, Double3 b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Double3 operator-(Double3 a, Double3 b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Double3 operator*(double s, Double3 v)
{
    return {s * v.x, s * v.y, s * v.z};
}
inline double dot(Double3 a, Double3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Double3 cross(Double3 a, Double3 b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length2(Double3 v)
{
    return dot(v, v);
}
inline double length(Double3 v)
{
    return std::sqrt(dot(v, v));
}
inline Double3 normalized(Double3 v)
{
    return (1 / length(v)) * v;
}
inline Double3 min(Double3 a, Double3 b)
{
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
inline Double3 max(Double3 a, Double3 b)
{
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
inline double largest(Double3 v)
{
    return std::max({v.x, v.y, v.z});
}
/// Rec. 709 luminance of linear RGB.
inline double luminanceOf(Double3 rgb)
{
    return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
}

/// |d|^2 with d's part along the normal n counting four times (lib/math.glsl).
inline double surfaceDistance2(Double3 d, Double3 n)
{
    return length2(d) + 15 * dot(d, n) * dot(d, n);
}

/// The unit vector at octahedral coordinates in -1..1 (Cigolle et al. 2014).
inline Double3 octahedralToUnit(double x, double y)
{
    const double z = 1 - std::abs(x) - std::abs(y), fold = std::max(-z, 0.0);
    return normalized({x + (x >= 0 ? -fold : fold), y + (y >= 0 ? -fold : fold), z});
}

/// Its inverse.
inline std::array<double, 2> unitToOctahedral(Double3 v)
{
    const double sum = std::abs(v.x) + std::abs(v.y) + std::abs(v.z), x = v.x / sum, y = v.y / sum;
    if (v.z >= 0)
        return {x, y};
    return {(1 - std::abs(y)) * (x >= 0 ? 1 : -1), (1 - std::abs(x)) * (y >= 0 ? 1 : -1)};
}

/// The unit vector that an octahedral encoding of 2 x 16-bit snorm stands for.
inline Double3 unpackedNormal(uint32_t bits)
{
    const auto snorm = [](uint32_t half) { return std::clamp(double(int16_t(half)) / 32767, -1.0, 1.0); };
    return octahedralToUnit(snorm(bits & 0xffff), snorm(bits >> 16));
}

/// Its inverse.
inline uint32_t packedNormal(Double3 v)
{
    const auto snorm = [](double value) { return uint32_t(uint16_t(int16_t(std::lround(value * 32767)))); };
    const auto [x, y] = unitToOctahedral(v);
    return snorm(x) | snorm(y) << 16;
}
