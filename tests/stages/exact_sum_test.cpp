// Sums without rounding against the same in whole numbers of 128 bits on the CPU.
#include "runtime/stages/exact_sum.h"
#include "tests/stages/gpu_test.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace
{
__extension__ typedef __int128 Int128;

class ExactSum : public GpuTest
{
};

/// A sample in units, cut off and cut short as shaders/resolve/exact_sum.h says. A long double holds all bits of a float's.
Int128 unitsOf(float sample)
{
    const float most = std::ldexp(float(0xffffff), 42 - 23);
    return Int128(std::trunc(std::ldexp((long double)(std::clamp(sample, -most, most)), 64)));
}

std::vector<float> samplesOfAllSizes(size_t count)
{
    std::mt19937 random(1);
    std::vector<float> samples(count);
    for (float& sample : samples)
        sample = std::bit_cast<float>(uint32_t(random()));
    const float special[] = {0,
                             -0.0f,
                             1,
                             -1,
                             std::numeric_limits<float>::max(),
                             -std::numeric_limits<float>::max(),
                             std::numeric_limits<float>::min(),
                             std::numeric_limits<float>::denorm_min(),
                             0x1p-64f,
                             0x1.fp-64f,
                             0x1p-65f,
                             -0x1p-65f,
                             0x1.fffffep42f,
                             0x1p43f,
                             INFINITY,
                             NAN};
    std::copy(std::begin(special), std::end(special), samples.begin());
    return samples;
}

TEST_F(ExactSum, IsThatOfWholeNumbersHoweverItIsSplit)
{
    constexpr uint32_t kPixels = 333, kSamples = 40;
    const std::vector<float> samples = samplesOfAllSizes(size_t(3) * kPixels * kSamples);
    std::vector<Int128> want(3 * kPixels);
    uint32_t non_finite = 0;
    for (size_t i = 0; i < samples.size(); i += 3)
        if (std::isfinite(samples[i]) && std::isfinite(samples[i + 1]) && std::isfinite(samples[i + 2]))
            for (size_t c = 0; c < 3; ++c)
                want[i % (3 * kPixels) + c] += unitsOf(samples[i + c]);
        else
            ++non_finite;
    ASSERT_GT(non_finite, 0u);
    const Buffer radiance = device().upload<float>("test.radiance", samples);
    for (const std::vector<uint32_t>& cuts : {std::vector<uint32_t>{0, kSamples}, {0, 1, 17, 18, kSamples}})
    {
        const ExactSumStage stage(device(), kPixels);
        Recorder rec(device());
        rec.begin();
        stage.clear(rec);
        for (size_t cut = cuts.size() - 1; cut > 0; --cut) // the last first
            stage.record(rec, radiance, cuts[cut - 1], cuts[cut]);
        rec.submitAndWait();
        const auto words = device().download<uint32_t>(stage.sums(), 12 * kPixels);
        for (size_t i = 0; i < want.size(); ++i)
            for (uint32_t word = 0; word < 4; ++word)
                ASSERT_EQ(words[4 * i + word], uint32_t(want[i] >> (32 * word))) << i << " word " << word;
        EXPECT_EQ(device().download<uint32_t>(stage.nonFiniteCount(), 1)[0], non_finite);
    }
}
} // namespace
