#include "compiler/encode.h"

#include <algorithm>
#include <bit>

namespace
{
/// Octahedral map of a unit vector to [-1, 1]^2 (Meyer et al. 2010).
gpu::vec2 octahedral(gpu::vec3 n)
{
    const float sum = std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z);
    const float x = n.x / sum;
    const float y = n.y / sum;
    if (n.z >= 0)
        return {x, y};
    return {(1 - std::fabs(y)) * (x >= 0 ? 1.0f : -1.0f), (1 - std::fabs(x)) * (y >= 0 ? 1.0f : -1.0f)};
}

gpu::vec3 fromOctahedral(float x, float y)
{
    gpu::vec3 n{x, y, 1 - std::fabs(x) - std::fabs(y)};
    const float fold = std::max(-n.z, 0.0f);
    n.x += n.x >= 0 ? -fold : fold;
    n.y += n.y >= 0 ? -fold : fold;
    return normalizeOr(n, {0, 0, 1});
}

int32_t snorm(float v, float scale)
{
    return int32_t(std::lround(std::clamp(v, -1.0f, 1.0f) * scale));
}

uint16_t encodeHalf(float f)
{
    const float clamped = std::isnan(f) ? 0.0f : std::clamp(f, -65504.0f, 65504.0f);
    const uint32_t sign = std::signbit(clamped) ? 0x8000u : 0u;
    const float a = std::fabs(clamped);
    if (a < 0x1p-14f) // subnormal
        return uint16_t(sign | uint32_t(std::lrint(a * 0x1p24f)));
    const uint32_t bits = std::bit_cast<uint32_t>(a);
    const uint32_t rounded = bits + 0xfffu + ((bits >> 13) & 1u); // to nearest even
    return uint16_t(sign | ((rounded >> 13) - (112u << 10)));
}
} // namespace

uint32_t encodeNormal(gpu::vec3 n)
{
    const gpu::vec2 o = octahedral(n);
    return uint32_t(uint16_t(snorm(o.x, 32767))) | uint32_t(uint16_t(snorm(o.y, 32767))) << 16;
}

uint32_t encodeTangent(gpu::vec3 tangent, bool negative_bitangent)
{
    const gpu::vec2 o = octahedral(tangent);
    const uint32_t encoded = uint32_t(uint16_t(snorm(o.x, 32767))) | uint32_t(snorm(o.y, 16383)) << 17 |
                             (negative_bitangent ? 1u << 16 : 0u);
    return encoded == 0 ? 1u : encoded; // +Z: one step beside
}

gpu::uvec2 encodeColor(float r, float g, float b, float a)
{
    return {uint32_t(encodeHalf(r)) | uint32_t(encodeHalf(g)) << 16, uint32_t(encodeHalf(b)) | uint32_t(encodeHalf(a))
                                                                                                   << 16};
}

gpu::vec3 decodeNormal(uint32_t encoded)
{
    return fromOctahedral(std::max(float(int16_t(encoded & 0xffffu)) / 32767, -1.0f),
                          std::max(float(int16_t(encoded >> 16)) / 32767, -1.0f));
}

gpu::vec3 decodeTangent(uint32_t encoded)
{
    return fromOctahedral(std::max(float(int16_t(encoded & 0xffffu)) / 32767, -1.0f),
                          std::max(float(int32_t(encoded) >> 17) / 16383, -1.0f));
}

float decodeHalf(uint16_t half)
{
    const float magnitude = (half & 0x7c00u) == 0
                                ? float(half & 0x3ffu) * 0x1p-24f
                                : std::bit_cast<float>((uint32_t(half & 0x7fffu) << 13) + (112u << 23));
    return (half & 0x8000u) != 0 ? -magnitude : magnitude;
}
