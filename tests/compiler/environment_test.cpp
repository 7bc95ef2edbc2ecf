// Environment light: an importance grid that follows the filtered radiance.
#include "compiler/environment.h"
#include "compiler/vector_math.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace
{
constexpr double kPi = std::numbers::pi;

EnvironmentImage constant(uint32_t width, uint32_t height, float value)
{
    return {.width = width,
            .height = height,
            .texels = std::vector<gpu::vec4>(size_t(width) * height, {value, value, value, 1})};
}

/// Bilinear filter as samplers do it: u repeats, v clamps.
float filtered(const EnvironmentImage& image, double u, double v)
{
    const double x = u * image.width - 0.5;
    const double y = v * image.height - 0.5;
    const auto at = [&](double column, double row)
    {
        const auto c = uint32_t(int64_t(column) + image.width) % image.width;
        const auto r = uint32_t(std::clamp(row, 0.0, double(image.height - 1)));
        const gpu::vec4& t = image.texels[size_t(r) * image.width + c];
        return double(luminance({t.x, t.y, t.z}));
    };
    const double fx = x - std::floor(x);
    const double fy = y - std::floor(y);
    const double top = at(std::floor(x), std::floor(y)) * (1 - fx) + at(std::floor(x) + 1, std::floor(y)) * fx;
    const double low = at(std::floor(x), std::floor(y) + 1) * (1 - fx) + at(std::floor(x) + 1, std::floor(y) + 1) * fx;
    return float(top * (1 - fy) + low * fy);
}

/// Each cell's probability against its mean filtered luminance x solid angle. The midpoint rule is exact here: the
/// kinks of the bilinear filter fall between its kSteps parts of a cell.
void expectProportional(const EnvironmentImage& image, const EnvironmentImportance& importance)
{
    constexpr uint32_t kSteps = 6;
    std::vector<double> wanted;
    double total = 0;
    for (uint32_t row = 0; row < importance.height; ++row)
    {
        const double solid_angle =
            std::cos(kPi * row / importance.height) - std::cos(kPi * (row + 1) / importance.height);
        for (uint32_t column = 0; column < importance.width; ++column)
        {
            double sum = 0;
            for (uint32_t i = 0; i < kSteps * kSteps; ++i)
                sum += filtered(image, (column + (i % kSteps + 0.5) / kSteps) / importance.width,
                                (row + (i / kSteps + 0.5) / kSteps) / importance.height);
            wanted.push_back(sum * solid_angle);
            total += wanted.back();
        }
    }
    for (size_t i = 0; i < wanted.size(); ++i)
    {
        const double probability = importance.texels[i].probability;
        ASSERT_NEAR(probability, wanted[i] / total, 1e-5 * wanted[i] / total) << i; // single precision
        ASSERT_EQ(probability > 0, wanted[i] > 0) << i;
    }
}

EnvironmentImage randomImage(uint32_t width, uint32_t height)
{
    std::mt19937 engine(7);
    EnvironmentImage image = constant(width, height, 0);
    for (gpu::vec4& texel : image.texels)
    {
        if (engine() % 10 == 0)
            texel = {float(engine() % 1000), float(engine() % 100), float(engine() % 10), 1};
    }
    return image;
}
} // namespace

TEST(Importance, FollowsRadianceOnTheMapsOwnGrid)
{
    const EnvironmentImage image = randomImage(32, 16);
    const EnvironmentImportance importance = buildImportance(image);
    ASSERT_EQ(importance.width, 32u);
    ASSERT_EQ(importance.height, 16u);
    expectProportional(image, importance);
}

TEST(Importance, FollowsRadianceOnACoarserGrid)
{
    const EnvironmentImage image = randomImage(1536, 768);
    const EnvironmentImportance importance = buildImportance(image);
    ASSERT_EQ(importance.width, 1024u);
    ASSERT_EQ(importance.height, 512u);
    expectProportional(image, importance);
}

TEST(Importance, OfAConstantMapIsItsSolidAngle)
{
    const EnvironmentImportance importance = buildImportance(constant(16, 8, 3));
    for (uint32_t i = 0; i < 16 * 8; ++i)
    {
        const uint32_t row = i / 16;
        const double share = (std::cos(kPi * row / 8) - std::cos(kPi * (row + 1) / 8)) / 2 / 16;
        EXPECT_NEAR(importance.texels[i].probability, share, 1e-7);
    }
    EXPECT_NEAR(importance.average_radiance.x, 3, 1e-5);
    EXPECT_NEAR(importance.average_radiance.z, 3, 1e-5);
}

TEST(Importance, OfABlackMapIsStillADistribution)
{
    double sum = 0;
    for (const gpu::EnvironmentTexel& texel : buildImportance(constant(8, 4, 0)).texels)
        sum += texel.probability;
    EXPECT_NEAR(sum, 1, 1e-6);
}

TEST(Importance, KeepsTheDarkReachableBesideTheVeryBright)
{
    EnvironmentImage image = constant(64, 32, 1e-20f);
    image.texels[500] = {1e10f, 1e10f, 1e10f, 1};
    for (const gpu::EnvironmentTexel& texel : buildImportance(image).texels)
        EXPECT_GT(texel.probability, 0);
}

TEST(DefaultSky, IsBlueAboveAndBrownBelow)
{
    const EnvironmentImage sky = defaultSky();
    ASSERT_EQ(sky.texels.size(), size_t(256) * 128);
    EXPECT_GT(sky.texels.front().z, sky.texels.front().x);
    EXPECT_LT(sky.texels.back().z, sky.texels.back().x);
    EXPECT_NEAR(length(defaultSun().direction), 1, 1e-6);
    EXPECT_LT(defaultSun().direction.y, 0);
}
