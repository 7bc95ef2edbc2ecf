// Sums of samples in files: nothing is rounded, however they are split.
#include "image/read_exr.h"
#include "image/sample_sum.h"
#include "tests/tools/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace
{
constexpr uint32_t kWidth = 3, kHeight = 20;

/// Numbers of up to 126 bits, of every size and both signs.
SampleSum randomSum(uint32_t seed, SampleRange samples)
{
    std::mt19937_64 random(seed);
    SampleSum sum{.width = kWidth, .height = kHeight, .sums = {}, .samples = {samples}, .origin = {}};
    sum.origin = {.package = "0123", .version = "1 a", .settings = "seed 0\n", .samples = "", .device = "card"};
    for (size_t i = 0; i < size_t(3) * kWidth * kHeight; ++i)
    {
        const Int128 number = Int128(random() >> 2) << 64 | random(); // below 2^126
        sum.sums.push_back((random() % 2 ? 1 : -1) * (number >> random() % 127));
    }
    return sum;
}

std::string written(const TemporaryFolder& folder, const SampleSum& sum)
{
    EXPECT_TRUE(writeSampleSum(folder / "sum.exr", sum));
    return fileBytes(folder / "sum.exr");
}

TEST(SampleSum, IsReadAsWritten)
{
    const TemporaryFolder folder;
    const SampleSum sum = randomSum(1, {5, 9});
    written(folder, sum);
    const auto read = readSampleSum(folder / "sum.exr");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_TRUE(read->sums == sum.sums);
    EXPECT_EQ(read->sampleCount(), 5u);
    EXPECT_EQ(read->origin.samples, "5-9");
    EXPECT_EQ(difference(read->origin, sum.origin), "");
    const auto picture = readExr(folder / "sum.exr"); // and for every reader it is the mean
    ASSERT_TRUE(picture) << picture.error().message;
    for (size_t i = 0; i < sum.sums.size(); ++i)
        EXPECT_FLOAT_EQ(picture->rgb[i], float(std::ldexp((long double)(sum.sums[i]), -64) / 5)) << i;
}

TEST(SampleSum, HasTheSameBytesInWhateverOrderPartsAreAdded)
{
    const TemporaryFolder folder;
    const std::vector<SampleSum> parts{randomSum(1, {0, 3}), randomSum(2, {4, 4}), randomSum(3, {5, 20})};
    std::string first;
    for (const std::vector<size_t>& order : {std::vector<size_t>{0, 1, 2}, {2, 0, 1}, {1, 2, 0}})
    {
        SampleSum sum = parts[order[0]];
        for (SampleSum& half : std::vector<SampleSum>{parts[order[1]], parts[order[2]]})
            ASSERT_TRUE(addSamples(sum, half));
        EXPECT_EQ(samplesText(sum.samples), "0-20");
        const std::string bytes = written(folder, sum);
        EXPECT_TRUE(first.empty() || bytes == first);
        first = bytes;
    }
}

TEST(SampleSum, RefusesWhatIsNoPartOfTheSamePicture)
{
    SampleSum sum = randomSum(1, {0, 3});
    const auto refused = [&](const SampleSum& part, const std::string& words)
    {
        const Status status = addSamples(sum, part);
        ASSERT_FALSE(status) << words;
        EXPECT_EQ(status.error().code, ExitCode::kInvalid);
        EXPECT_NE(status.error().message.find(words), std::string::npos) << status.error().message;
    };
    refused(randomSum(1, {3, 5}), "holds sample 3");
    SampleSum other = randomSum(2, {8, 9});
    other.origin.package = "4567";
    refused(other, "another package (4567, not 0123)");
    other = randomSum(2, {8, 9});
    other.origin.settings = "seed 7\n";
    refused(other, "(seed 7, not 0)");
    other = randomSum(2, {8, 9});
    other.width *= 2;
    refused(other, "6x20 pixels");
    EXPECT_TRUE(addSamples(sum, randomSum(2, {8, 9})));
    EXPECT_EQ(samplesText(sum.samples), "0-3,8-9");
}
} // namespace
