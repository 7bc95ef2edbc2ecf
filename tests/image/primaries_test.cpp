// Conversions of colour against published matrices.
#include "image/primaries.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{
void expectNear(const std::optional<Matrix3>& matrix, const Matrix3& want, double tolerance)
{
    ASSERT_TRUE(matrix);
    for (size_t i = 0; i < 9; ++i)
        EXPECT_NEAR((*matrix)[i], want[i], tolerance) << i;
}

TEST(Primaries, Rec709ToXyzIsTheStandardsMatrix)
{
    // IEC 61966-2-1, to its four digits.
    expectNear(toXyz({}), {0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505}, 1e-4);
}

TEST(Primaries, Rec709IsLeftAlone)
{
    EXPECT_EQ(toRec709({}), kIdentity3);
    EXPECT_EQ(toRec709({{0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, {0.313, 0.329}}), kIdentity3);
}

TEST(Primaries, Rec2020ToRec709IsTheStandardsMatrix)
{
    // ITU-R BT.2407, section 2; the white is the same, so that nothing is adapted.
    expectNear(toRec709(Primaries{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}}),
               {1.6605, -0.5876, -0.0728, -0.1246, 1.1329, -0.0083, -0.0182, -0.1006, 1.1187}, 1e-4);
}

TEST(Primaries, AcesCgToRec709AdaptsItsWhite)
{
    // AP1 with the ACES white; the Bradford matrix as the Academy and OpenColorIO publish it.
    expectNear(toRec709(Primaries{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}}),
               {1.7051, -0.6218, -0.0833, -0.1303, 1.1408, -0.0105, -0.0240, -0.1290, 1.1530}, 2e-4);
}

TEST(Primaries, XyzIsNotAdapted)
{
    // The inverse of the standard's matrix.
    expectNear(toRec709(kXyzPrimaries), {3.2410, -1.5374, -0.4986, -0.9692, 1.8760, 0.0416, 0.0556, -0.2040, 1.0570},
               1e-3);
}

TEST(Primaries, WhatSpansNoColoursIsRefused)
{
    EXPECT_FALSE(toRec709(Primaries{{0, 0}, {0, 0}, {0, 0}, {0, 0}}));
    EXPECT_FALSE(toRec709(Primaries{{0.1, 0.1}, {0.2, 0.2}, {0.3, 0.3}, {0.3, 0.3}}));
    EXPECT_FALSE(toRec709(Primaries{{0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, {0.3, 0}}));
    EXPECT_FALSE(
        toRec709(Primaries{{std::numeric_limits<double>::quiet_NaN(), 0.33}, {0.3, 0.6}, {0.15, 0.06}, {0.3, 0.3}}));
}
} // namespace
