#include "compiler/encode.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
/// Evenly spread unit vectors (Fibonacci lattice), the axes among the neighbours.
gpu::vec3 direction(int i, int count)
{
    const float z = 1 - (2 * float(i) + 1) / float(count);
    const float r = std::sqrt(1 - z * z);
    const float a = 2.39996323f * float(i);
    return {r * std::cos(a), r * std::sin(a), z};
}

TEST(Encode, NormalsComeBackWithinTheirStep)
{
    // One 16-bit step of the octahedral map moves a direction by at most about 2 sqrt(2) / 32767.
    const float bound = 2.0f * std::sqrt(2.0f) / 32767;
    for (int i = 0; i < 10000; ++i)
    {
        const gpu::vec3 n = direction(i, 10000);
        EXPECT_LT(length(decodeNormal(encodeNormal(n)) - n), bound) << i;
    }
}

TEST(Encode, TangentsKeepDirectionAndSignAndAreNeverZero)
{
    const float bound = 2.0f * std::sqrt(2.0f) / 16383;
    for (int i = 0; i < 10000; ++i)
        for (const bool negative : {false, true})
        {
            const gpu::vec3 t = i == 0 ? gpu::vec3{0, 0, 1} : direction(i, 10000);
            const uint32_t encoded = encodeTangent(t, negative);
            EXPECT_NE(encoded, 0u);
            EXPECT_EQ((encoded >> 16 & 1u) != 0, negative);
            EXPECT_LT(length(decodeTangent(encoded) - t), bound) << i;
        }
}

TEST(Encode, HalfsRoundToNearestEven)
{
    const auto half = [](float f) { return uint16_t(encodeColor(f, 0, 0, 0).x); };
    EXPECT_EQ(half(1), 0x3c00);
    EXPECT_EQ(half(0.5f), 0x3800);
    EXPECT_EQ(half(65504), 0x7bff);
    EXPECT_EQ(half(1e9f), 0x7bff);            // clamped
    EXPECT_EQ(half(1 + 1.0f / 2048), 0x3c00); // halfway: to even
    EXPECT_EQ(half(1 + 3.0f / 2048), 0x3c02);
    EXPECT_EQ(half(0x1p-24f), 0x0001); // smallest subnormal
    EXPECT_EQ(half(0x1p-14f), 0x0400); // smallest normal
    EXPECT_EQ(half(0), 0);
    for (uint32_t h = 0; h < 0x7c00; ++h)
        EXPECT_EQ(half(decodeHalf(uint16_t(h))), h);
}
} // namespace
