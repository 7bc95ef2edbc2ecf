#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/resolve/exact_sum.h"

// Adds samples of one pass to each pixel's sum, without rounding. One thread per channel of a pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { AddExactlyParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Radiance { float radiance[]; };
layout(set = 1, binding = 1, scalar) buffer Sums { uint sums[]; };
layout(set = 1, binding = 2, scalar) buffer NonFinite { uint non_finite_count; };

/// The absolute value of a finite number in units of the sum.
uvec4 fixedPoint(uint bits)
{
    const int kBias = 127, kFractionBits = 23;
    int exponent = int(bits >> kFractionBits & 0xffu);
    uint fraction = bits & 0x7fffffu;
    if (exponent > kBias + int(kExactLargestExponent))
    {
        exponent = kBias + int(kExactLargestExponent);
        fraction = 0x7fffffu;
    }
    uint mantissa = exponent == 0 ? fraction : fraction | 0x800000u;
    int shift = max(exponent, 1) - kBias - kFractionBits + int(kExactUnitBits);
    if (shift < 0)
        return uvec4(shift <= -32 ? 0u : mantissa >> uint(-shift), 0u, 0u, 0u);
    uint word = uint(shift) >> 5, within = uint(shift) & 31u;
    uvec4 value = uvec4(0u);
    value[word] = mantissa << within;
    if (within > 0u)
        value[word + 1u] = mantissa >> (32u - within);
    return value;
}

uvec4 sum(uvec4 a, uvec4 b)
{
    uint carry = 0u;
    for (int i = 0; i < 4; ++i)
    {
        uint first, second;
        uint partial = uaddCarry(a[i], b[i], first);
        a[i] = uaddCarry(partial, carry, second);
        carry = first + second;
    }
    return a;
}

uvec4 negative(uvec4 a) { return sum(~a, uvec4(1u, 0u, 0u, 0u)); }

bool isFinite(uint bits) { return (bits & 0x7f800000u) != 0x7f800000u; }

void main()
{
    uint i = gl_GlobalInvocationID.x; // 3 * pixel + channel
    if (i >= 3u * params.pixel_count)
        return;
    uint pixel = i / 3u, channel = i - 3u * pixel;
    uvec4 total = uvec4(sums[4u * i], sums[4u * i + 1u], sums[4u * i + 2u], sums[4u * i + 3u]);
    for (uint s = params.first; s < params.last; ++s)
    {
        uint at = 3u * (s * params.pixel_count + pixel);
        uvec3 bits = floatBitsToUint(vec3(radiance[at], radiance[at + 1u], radiance[at + 2u]));
        if (!isFinite(bits.x) || !isFinite(bits.y) || !isFinite(bits.z)) // a sample is left out whole
        {
            if (channel == 0u)
                atomicAdd(non_finite_count, 1u);
            continue;
        }
        uvec4 value = fixedPoint(bits[channel]);
        total = sum(total, bits[channel] >> 31 != 0u ? negative(value) : value);
    }
    for (uint word = 0u; word < 4u; ++word)
        sums[4u * i + word] = total[word];
}
