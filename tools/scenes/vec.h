// The little vector arithmetic that scene building needs.
#pragma once
#include <cmath>

struct Vec2
{
    float x = 0, y = 0;
};

struct Vec3
{
    float x = 0, y = 0, z = 0;
};

inline Vec3 operator+(Vec3 a, Vec3 b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(Vec3 a, Vec3 b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator-(Vec3 a)
{
    return {-a.x, -a.y, -a.z};
}
inline Vec3 operator*(Vec3 a, float s)
{
    return {a.x * s, a.y * s, a.z * s};
}
inline float dot(Vec3 a, Vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(Vec3 a, Vec3 b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(Vec3 a)
{
    return std::sqrt(dot(a, a));
}
inline Vec3 normalize(Vec3 a)
{
    return a * (1.0f / length(a));
}

/// Turns (axes orthonormal, right-handed), then shifts.
struct Placement
{
    Vec3 x_axis{1, 0, 0}, y_axis{0, 1, 0}, z_axis{0, 0, 1}, origin{};

    Vec3 direction(Vec3 v) const { return x_axis * v.x + y_axis * v.y + z_axis * v.z; }
    Vec3 point(Vec3 v) const { return direction(v) + origin; }
};

inline Placement at(float x, float y, float z)
{
    return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {x, y, z}};
}

/// Turned by `radians` about +Y (x towards -z), then shifted.
inline Placement turned(float radians, Vec3 origin)
{
    const float c = std::cos(radians), s = std::sin(radians);
    return {{c, 0, -s}, {0, 1, 0}, {s, 0, c}, origin};
}
