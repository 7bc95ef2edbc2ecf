// Colour spaces of FLIP. White is D65 as the sum of the matrix rows below.
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

struct Color
{
    float x, y, z;
};

/// Accurate to a few units in the last place for 1e-30 < x < 1e30; unlike std::cbrt, loops over it vectorise.
inline float cubeRoot(float x)
{
    const float third_of_bits = float(std::bit_cast<int32_t>(x)) * (1.0f / 3.0f); // a third of the exponent, roughly
    float root = std::bit_cast<float>(int32_t(third_of_bits) + 709921077);
    for (int i = 0; i < 2; ++i) // Halley: each step triples the number of good digits
    {
        const float cube = root * root * root;
        root *= (cube + 2.0f * x) / (2.0f * cube + x);
    }
    return root;
}

/// CIE XYZ divided by the white point.
inline Color relativeXyz(Color rgb)
{
    return {(10135552.0f * rgb.x + 8788810.0f * rgb.y + 4435075.0f * rgb.z) * (1.0f / 23359437.0f),
            (2613072.0f * rgb.x + 8788810.0f * rgb.y + 887015.0f * rgb.z) * (1.0f / 12288897.0f),
            (1425312.0f * rgb.x + 8788810.0f * rgb.y + 70074185.0f * rgb.z) * (1.0f / 80288307.0f)};
}

/// Linearised CIELAB: opponent colour in which blurring is physically right. x: achromatic, y: red-green, z:
/// blue-yellow.
inline Color ycxczFromRgb(Color rgb)
{
    const Color v = relativeXyz(rgb);
    return {116.0f * v.y - 16.0f, 500.0f * (v.x - v.y), 200.0f * (v.y - v.z)};
}

inline Color rgbFromYcxcz(Color c)
{
    const float relative_y = (c.x + 16.0f) * (1.0f / 116.0f);
    const float x = (relative_y + c.y * (1.0f / 500.0f)) * 0.950428545f;
    const float y = relative_y;
    const float z = (relative_y - c.z * (1.0f / 200.0f)) * 1.088900371f;
    return {3.241003275f * x - 1.537398934f * y - 0.498615861f * z,
            -0.969224334f * x + 1.875930071f * y + 0.041554224f * z,
            0.055639423f * x - 0.204011202f * y + 1.057148933f * z};
}

/// CIELAB of linear RGB in 0..1, its chroma scaled by lightness (the Hunt effect: colours look stronger when bright).
inline Color huntLab(Color rgb)
{
    const auto compress = [](float v)
    {
        constexpr float kDelta = 6.0f / 29.0f;
        constexpr float kKnee = kDelta * kDelta * kDelta;
        const float root = cubeRoot(v > kKnee ? v : kKnee); // on both sides of the knee: no branch, so it vectorises
        return v > kKnee ? root : v * (1.0f / (3.0f * kDelta * kDelta)) + 4.0f / 29.0f;
    };
    const Color v = relativeXyz(rgb);
    const float x = compress(v.x);
    const float y = compress(v.y);
    const float z = compress(v.z);
    const float lightness = 116.0f * y - 16.0f;
    return {lightness, 0.01f * lightness * 500.0f * (x - y), 0.01f * lightness * 200.0f * (y - z)};
}

/// City-block in lightness, Euclidean in chroma: fits large colour differences.
inline float hyab(Color a, Color b)
{
    const float dy = a.y - b.y;
    const float dz = a.z - b.z;
    return std::abs(a.x - b.x) + std::sqrt(dy * dy + dz * dz);
}

/// The ACES filmic fit (Narkowicz) with its built-in exposure of 0.6 applied, clamped to 0..1.
inline constexpr float kAces[6] = {0.6f * 0.6f * 2.51f, 0.6f * 0.03f, 0.0f, 0.6f * 0.6f * 2.43f, 0.6f * 0.59f, 0.14f};

inline float acesCurve(float x)
{
    const float shown = (kAces[0] * x * x + kAces[1] * x + kAces[2]) / (kAces[3] * x * x + kAces[4] * x + kAces[5]);
    return std::clamp(shown, 0.0f, 1.0f);
}
