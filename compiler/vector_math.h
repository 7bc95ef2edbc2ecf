// Vector arithmetic for building hierarchies and lights.
#pragma once
#include "format/vec3d.h"

#include <algorithm>
#include <cmath>

inline gpu::vec3 operator+(const gpu::vec3& a, const gpu::vec3& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline gpu::vec3 operator-(const gpu::vec3& a, const gpu::vec3& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline gpu::vec3 operator*(const gpu::vec3& a, float s)
{
    return {a.x * s, a.y * s, a.z * s};
}
inline float dot(const gpu::vec3& a, const gpu::vec3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline float length(const gpu::vec3& v)
{
    return std::sqrt(dot(v, v));
}
inline gpu::vec3 cross(const gpu::vec3& a, const gpu::vec3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline gpu::vec3 min(const gpu::vec3& a, const gpu::vec3& b)
{
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
inline gpu::vec3 max(const gpu::vec3& a, const gpu::vec3& b)
{
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
