// Sums and display transforms against the same in double precision.
#include "runtime/stages/resolve.h"
#include "tests/stages/gpu_test.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace
{
using Rgb = std::array<double, 3>;

class Resolve : public GpuTest
{
protected:
    /// Runs `record` in one submission.
    static void submit(const std::function<void(Recorder&)>& record)
    {
        Recorder rec(device());
        rec.begin();
        record(rec);
        rec.submitAndWait();
    }

    /// The bytes of `radiance` by way of one accumulated sample a pixel, four a pixel.
    static std::vector<uint8_t> displayed(const std::vector<gpu::vec3>& radiance, float exposure, Tonemap tonemap,
                                          bool bgra)
    {
        const uint32_t count = uint32_t(radiance.size());
        ResolveStage stage(device(), count);
        const Buffer input = device().upload<gpu::vec3>("test.radiance", radiance);
        const Buffer* pixels = nullptr;
        submit(
            [&](Recorder& rec)
            {
                stage.restart(rec);
                stage.accumulate(rec, input, count, 1);
                pixels = &stage.display(rec, count, exposure, tonemap, bgra);
            });
        return device().download<uint8_t>(*pixels, 4 * count);
    }
};

// ---- Accumulation --------------------------------------------------------------------------------------------------

TEST_F(Resolve, SumsAHundredThousandSamplesWithoutLosingThem)
{
    constexpr uint32_t kPixels = 100, kSamplesPerPass = 1000, kPasses = 100;
    const auto value = [](uint32_t pixel) { return 0.1f + 0.01f * float(pixel); };
    std::vector<gpu::vec3> radiance;
    for (uint32_t s = 0; s < kSamplesPerPass; ++s)
        for (uint32_t p = 0; p < kPixels; ++p)
            radiance.push_back({value(p), 10 * value(p), -value(p)});
    ResolveStage stage(device(), kPixels);
    const Buffer input = device().upload<gpu::vec3>("test.radiance", radiance);
    submit(
        [&](Recorder& rec)
        {
            stage.restart(rec);
            for (uint32_t pass = 0; pass < kPasses; ++pass)
                stage.accumulate(rec, input, kPixels, kSamplesPerPass);
        });
    constexpr uint32_t kSamples = kSamplesPerPass * kPasses;
    EXPECT_EQ(stage.sampleCount(), kSamples);
    float naive = 0;
    for (uint32_t s = 0; s < kSamples; ++s)
        naive += value(0);
    // Kahan's bound is 2 ulps of the sum, and another for 10 x value: far below what plain sums lose.
    constexpr double kTolerance = 2e-7;
    EXPECT_GT(std::abs(naive / (double(value(0)) * kSamples) - 1), 100 * kTolerance);
    const auto sum = device().download<gpu::vec3>(stage.sum(), kPixels);
    for (uint32_t p = 0; p < kPixels; ++p)
    {
        const double expected = double(value(p)) * kSamples;
        EXPECT_NEAR(sum[p].x / expected, 1, kTolerance) << p;
        EXPECT_NEAR(sum[p].y / (double(10 * value(p)) * kSamples), 1, kTolerance) << p;
        EXPECT_NEAR(sum[p].z / -expected, 1, kTolerance) << p;
    }
}

TEST_F(Resolve, KeepsSmallSamplesBesideLargeOnes)
{
    constexpr uint32_t kSmall = 4096;
    std::vector<gpu::vec3> radiance(kSmall + 1, {0.25f, 0.25f, 0.25f});
    radiance[0] = {0x1p24f, 0x1p26f, 0}; // 0.25 is below half their ulp
    ResolveStage stage(device(), 1);
    const Buffer input = device().upload<gpu::vec3>("test.radiance", radiance);
    submit(
        [&](Recorder& rec)
        {
            stage.restart(rec);
            stage.accumulate(rec, input, 1, kSmall + 1);
        });
    const auto sum = device().download<gpu::vec3>(stage.sum(), 1)[0];
    EXPECT_EQ(sum.x, 0x1p24f + 0.25f * kSmall);
    EXPECT_EQ(sum.y, 0x1p26f + 0.25f * kSmall);
    EXPECT_EQ(sum.z, 0.25f * kSmall);
}

TEST_F(Resolve, LeavesOutSamplesThatAreNotFiniteAndCountsThem)
{
    constexpr uint32_t kPixels = 70, kSamples = 8; // more than a group of threads
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const std::array<float, 3> bad{nan, infinity, -infinity};
    std::vector<gpu::vec3> radiance(kPixels * kSamples, {1, 2, 4});
    uint32_t bad_count = 0;
    std::vector<uint32_t> good(kPixels, kSamples);
    for (uint32_t i = 0; i < radiance.size(); i += 5, ++bad_count)
    {
        std::array<float, 3> rgb{1, 2, 4};
        rgb[bad_count % 3] = bad[bad_count / 3 % 3];
        radiance[i] = {rgb[0], rgb[1], rgb[2]};
        --good[i % kPixels];
    }
    ResolveStage stage(device(), kPixels);
    const Buffer input = device().upload<gpu::vec3>("test.radiance", radiance);
    const auto expectTwoPasses = [&]
    {
        submit(
            [&](Recorder& rec)
            {
                stage.restart(rec); // also forgets what is there already
                stage.accumulate(rec, input, kPixels, kSamples);
                stage.accumulate(rec, input, kPixels, kSamples);
            });
        EXPECT_EQ(device().download<uint32_t>(stage.nonFiniteCount(), 1)[0], 2 * bad_count);
        const auto sum = device().download<gpu::vec3>(stage.sum(), kPixels);
        for (uint32_t p = 0; p < kPixels; ++p)
        {
            EXPECT_EQ(sum[p].x, 2.0f * float(good[p])) << p;
            EXPECT_EQ(sum[p].y, 4.0f * float(good[p])) << p;
            EXPECT_EQ(sum[p].z, 8.0f * float(good[p])) << p;
        }
    };
    expectTwoPasses();
    expectTwoPasses();
}

// ---- Display -------------------------------------------------------------------------------------------------------

double clamp01(double x)
{
    return std::min(std::max(x, 0.0), 1.0);
}

/// IEC 61966-2-1.
double srgbEncoded(double x)
{
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

Rgb multiply(const std::array<Rgb, 3>& rows, const Rgb& v)
{
    Rgb out{};
    for (size_t i = 0; i < 3; ++i)
        out[i] = rows[i][0] * v[0] + rows[i][1] * v[1] + rows[i][2] * v[2];
    return out;
}

/// Solves rows x = v (Cramer).
Rgb solve(const std::array<Rgb, 3>& rows, const Rgb& v)
{
    const auto determinant = [](const std::array<Rgb, 3>& m)
    {
        return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    };
    Rgb x{};
    for (size_t column = 0; column < 3; ++column)
    {
        std::array<Rgb, 3> replaced = rows;
        for (size_t i = 0; i < 3; ++i)
            replaced[i][column] = v[i];
        x[column] = determinant(replaced) / determinant(rows);
    }
    return x;
}

Rgb agx(const Rgb& rgb)
{
    constexpr std::array<Rgb, 3> kInset{{{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                                         {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                                         {0.0423756549057051, 0.0784336, 0.879142973793104}}};
    Rgb x = multiply(kInset, {std::max(rgb[0], 0.0), std::max(rgb[1], 0.0), std::max(rgb[2], 0.0)});
    for (double& c : x)
    {
        const double stops = clamp01((std::log2(std::max(c, 1e-10)) + 12.47393) / (4.026069 + 12.47393));
        c = 0;
        for (const double coefficient : {15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232}) // Horner
            c = c * stops + coefficient;
    }
    Rgb out = solve(kInset, x);
    for (double& c : out)
        c = clamp01(std::pow(std::max(c, 0.0), 2.2));
    return out;
}

Rgb curveOf(Tonemap tonemap, const Rgb& rgb)
{
    if (tonemap == Tonemap::kAgx)
        return agx(rgb);
    Rgb out{};
    for (size_t i = 0; i < 3; ++i)
    {
        const double x = rgb[i];
        out[i] = clamp01(tonemap == Tonemap::kAces ? x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14) : x);
    }
    return out;
}

/// Black, greys and colours from far below to far above what a display can show.
std::vector<gpu::vec3> testColors()
{
    std::vector<gpu::vec3> colors{{0, 0, 0}, {1e-30f, 0, 0}, {1e30f, 1e30f, 1e30f}};
    for (int i = -60; i <= 50; ++i)
    {
        const float x = std::exp2(float(i) / 4);
        for (const gpu::vec3& hue :
             {gpu::vec3{1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0.5f, 0.1f}, {0.2f, 0.9f, 0.7f}})
            colors.push_back({x * hue.x, x * hue.y, x * hue.z});
    }
    return colors;
}

class Curves : public Resolve, public testing::WithParamInterface<Tonemap>
{
};

TEST_P(Curves, AreTheirFormulasToAByte)
{
    const std::vector<gpu::vec3> colors = testColors();
    for (const float exposure : {0.0f, -2.5f, 3.0f})
    {
        const std::vector<uint8_t> bytes = displayed(colors, exposure, GetParam(), false);
        for (size_t i = 0; i < colors.size(); ++i)
        {
            const double scale = std::exp2(double(exposure));
            const Rgb expected = curveOf(GetParam(), {scale * colors[i].x, scale * colors[i].y, scale * colors[i].z});
            for (size_t k = 0; k < 3; ++k)
                EXPECT_LE(std::abs(bytes[4 * i + k] - 255 * srgbEncoded(expected[k])), 0.51) // rounded to the nearest
                    << colors[i].x << " " << colors[i].y << " " << colors[i].z << " at " << exposure
                    << " stops, channel " << k;
            EXPECT_EQ(bytes[4 * i + 3], 255);
        }
    }
}

TEST_P(Curves, RiseWithGreyAndKeepItGrey)
{
    std::vector<gpu::vec3> greys;
    for (int i = 0; i <= 1000; ++i)
    {
        const float grey = std::exp2(float(i - 700) / 50);
        greys.push_back({grey, grey, grey});
    }
    const std::vector<uint8_t> bytes = displayed(greys, 0, GetParam(), false);
    for (size_t i = 0; i < greys.size(); ++i)
    {
        EXPECT_NEAR(bytes[4 * i], bytes[4 * i + 1], 1) << greys[i].x;
        EXPECT_NEAR(bytes[4 * i], bytes[4 * i + 2], 1) << greys[i].x;
        EXPECT_GE(bytes[4 * i], i > 0 ? bytes[4 * (i - 1)] : 0) << greys[i].x;
    }
    EXPECT_LE(bytes.front(), 2);
    EXPECT_GE(bytes[bytes.size() - 2], 253);
}

TEST_P(Curves, SwapRedAndBlueForBgra)
{
    const std::vector<gpu::vec3> colors = testColors();
    const std::vector<uint8_t> rgba = displayed(colors, 0, GetParam(), false),
                               bgra = displayed(colors, 0, GetParam(), true);
    for (size_t i = 0; i < rgba.size(); i += 4)
    {
        EXPECT_EQ(rgba[i], bgra[i + 2]);
        EXPECT_EQ(rgba[i + 1], bgra[i + 1]);
        EXPECT_EQ(rgba[i + 2], bgra[i]);
        EXPECT_EQ(rgba[i + 3], bgra[i + 3]);
    }
}

INSTANTIATE_TEST_SUITE_P(, Curves, testing::Values(Tonemap::kSrgb, Tonemap::kAces, Tonemap::kAgx),
                         [](const auto& curve) {
                             return curve.param == Tonemap::kSrgb   ? "Srgb"
                                    : curve.param == Tonemap::kAces ? "Aces"
                                                                    : "Agx";
                         });

TEST_F(Resolve, DisplaysTheMeanOfTheSamples)
{
    constexpr uint32_t kSamples = 7;
    std::vector<gpu::vec3> radiance;
    for (uint32_t s = 0; s < kSamples; ++s)
        radiance.push_back({float(s) / kSamples, 0.5f, 0.1f * float(s)});
    ResolveStage stage(device(), 1);
    const Buffer input = device().upload<gpu::vec3>("test.radiance", radiance);
    const Buffer* pixels = nullptr;
    submit(
        [&](Recorder& rec)
        {
            stage.restart(rec);
            stage.accumulate(rec, input, 1, kSamples);
            pixels = &stage.display(rec, 1, 0, Tonemap::kSrgb, false);
        });
    const auto bytes = device().download<uint8_t>(*pixels, 4);
    const Rgb mean{double(kSamples - 1) / (2 * kSamples), 0.5, 0.1 * (kSamples - 1) / 2};
    for (size_t k = 0; k < 3; ++k)
        EXPECT_LE(std::abs(bytes[k] - 255 * srgbEncoded(mean[k])), 0.51) << k;
}
} // namespace
