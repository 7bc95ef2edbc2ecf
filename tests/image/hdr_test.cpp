// Radiance pictures: every way of storing one gives the same picture; what the header divides out and converts; damage.
#include "image/read_hdr.h"
#include "tests/image/collect.h"
#include "tests/image/hdr_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace
{
ImageF readBack(const std::vector<std::byte>& file)
{
    Collected collected;
    const Status status = readHdr(file, collected);
    EXPECT_TRUE(status) << (status ? "" : status.error().message);
    return collected.image;
}

void expectRefused(const std::vector<std::byte>& file, ExitCode code, const std::string& words)
{
    Collected collected;
    const Status status = readHdr(file, collected);
    ASSERT_FALSE(status);
    EXPECT_EQ(int(status.error().code), int(code)) << status.error().message;
    EXPECT_NE(status.error().message.find(words), std::string::npos) << status.error().message;
}

std::vector<std::byte> bytesOf(const std::string& text)
{
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    return {bytes, bytes + text.size()};
}

const std::string kHead = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";

TEST(Hdr, MantissaTimesTwoToTheExponentMinus136)
{
    const std::string pixels = {char(128), 64, 32, char(129), 9, 9, 9, 0, 16, 16, 16, char(136), 1, 2, 3, char(137)};
    const ImageF image = readBack(bytesOf(kHead + "-Y 2 +X 2\n" + pixels));
    EXPECT_EQ(image.rgb, (std::vector<float>{1, 0.5f, 0.25f, 0, 0, 0, 16, 16, 16, 2, 4, 6}));
}

TEST(Hdr, EveryEncodingAndOrientationGivesTheSamePicture)
{
    // Narrower than 8 pixels there are no new runs; 700 is wide enough for repetitions of more than 255 pixels.
    for (const auto& [width, height] :
         {std::pair{700u, 40u}, {40u, 700u}, {9u, 8u}, {8u, 9u}, {1u, 1u}, {3u, 1u}, {7u, 5u}})
    {
        const ImageF image = exactHdrImage(width, height, width);
        for (const char* orientation : {"-Y +X", "+Y +X", "-Y -X", "+Y -X", "+X -Y", "-X -Y", "+X +Y", "-X +Y"})
            for (const HdrRuns runs : {HdrRuns::kFlat, HdrRuns::kOld, HdrRuns::kNew})
            {
                const uint32_t pixels = orientation[1] == 'Y' ? width : height;
                if (runs == HdrRuns::kNew && pixels < 8)
                    continue;
                const ImageF back = readBack(writeHdr(image, {.runs = runs, .orientation = orientation}));
                ASSERT_EQ(back.width, width);
                ASSERT_EQ(back.height, height);
                ASSERT_EQ(back.rgb, image.rgb)
                    << orientation << ", runs " << int(runs) << ", " << width << " x " << height;
            }
    }
}

TEST(Hdr, LinesMayDifferInEncoding)
{
    const ImageF image = exactHdrImage(20, 1, 3);
    std::vector<std::byte> file = bytesOf(kHead + "-Y 3 +X 20\n");
    for (const HdrRuns runs : {HdrRuns::kOld, HdrRuns::kNew, HdrRuns::kFlat})
    {
        const std::vector<std::byte> one = writeHdr(image, {.runs = runs});
        const size_t head = kHead.size() + std::string("-Y 1 +X 20\n").size();
        file.insert(file.end(), one.begin() + ptrdiff_t(head), one.end());
    }
    std::vector<float> three;
    for (int i = 0; i < 3; ++i)
        three.insert(three.end(), image.rgb.begin(), image.rgb.end());
    EXPECT_EQ(readBack(file).rgb, three);
}

TEST(Hdr, HeadersOfManyKindsAreRead)
{
    const ImageF image = exactHdrImage(16, 8, 1);
    for (const HdrStyle& style :
         {HdrStyle{.magic = "#?RGBE"},
          {.lines = ""},
          {.lines = "# " + std::string(5000, 'x') + "\nVIEW= -vta\nGAMMA=1\n"},
          {.lines = "FORMAT= 32-bit_rle_rgbe\nPRIMARIES=0 0 0 0 0 0 0 0\n"},
          {.lines = "pfilt -x 4\n\tEXPOSURE=7\nSOFTWARE=a = b\n"}, // what is indented belongs to another picture
          {.magic = "#?RADIANCE\r", .lines = "FORMAT=32-bit_rle_rgbe\r\n\r"},
          {.lines = "PRIMARIES=0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\n"}})
        EXPECT_EQ(readBack(writeHdr(image, style)).rgb, image.rgb) << style.magic << style.lines.substr(0, 60);
}

TEST(Hdr, ExposuresAndColorCorrectionsMultiplyAndAreDividedOut)
{
    const ImageF image = exactHdrImage(16, 8, 2);
    const ImageF back = readBack(writeHdr(
        image,
        {.lines = "EXPOSURE=2\nFORMAT=32-bit_rle_rgbe\nEXPOSURE= 4.0\nCOLORCORR= 1 2 0.5\nCOLORCORR=+2e0 1 1\n"}));
    for (size_t i = 0; i < image.rgb.size(); i += 3)
    {
        ASSERT_EQ(back.rgb[i], image.rgb[i] / 16);
        ASSERT_EQ(back.rgb[i + 1], image.rgb[i + 1] / 16);
        ASSERT_EQ(back.rgb[i + 2], image.rgb[i + 2] / 4);
    }
}

TEST(Hdr, WhiteStaysWhiteWhateverThePrimaries)
{
    const ImageF grey{8, 1, std::vector<float>(24, 4)};
    const ImageF back =
        readBack(writeHdr(grey, {.lines = "PRIMARIES= 0.708 0.292 0.170 0.797 0.131 0.046 0.3333 0.3333\n"}));
    for (const float value : back.rgb)
        ASSERT_NEAR(value, 4, 4e-6);
}

/// The matrix of IEC 61966-2-1 applied to (.25, .5, .75).
TEST(Hdr, XyzBecomesRec709)
{
    ImageF image{8, 1, {}};
    for (int i = 0; i < 8; ++i)
        image.rgb.insert(image.rgb.end(), {0.25f, 0.5f, 0.75f});
    const ImageF back = readBack(writeHdr(image, {.lines = "FORMAT=32-bit_rle_xyze\n"}));
    EXPECT_NEAR(back.rgb[0], 3.2406 * 0.25 - 1.5372 * 0.5 - 0.4986 * 0.75, 2e-3); // four digits, white 0.3127 0.3290
    EXPECT_NEAR(back.rgb[1], -0.9689 * 0.25 + 1.8758 * 0.5 + 0.0415 * 0.75, 2e-3);
    EXPECT_NEAR(back.rgb[2], 0.0557 * 0.25 - 0.2040 * 0.5 + 1.0570 * 0.75, 2e-3);
}

TEST(Hdr, WhatCannotBeIsRefusedWithASentence)
{
    const std::string pixel = {9, 9, 9, char(130)};
    expectRefused(bytesOf("P6 1 1 255"), ExitCode::kInvalid, "no Radiance");
    expectRefused({}, ExitCode::kInvalid, "no Radiance");
    expectRefused(bytesOf("#?RADIANCE\nFORMAT=32-bit"), ExitCode::kInvalid, "within its header");
    expectRefused(bytesOf("#?RADIANCE\nFORMAT=32-bit_rle_spectra\n\n-Y 1 +X 1\n" + pixel), ExitCode::kUnsupported,
                  "spectra");
    expectRefused(bytesOf("#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n" + pixel), ExitCode::kInvalid, "EXPOSURE=0");
    expectRefused(bytesOf("#?RADIANCE\nEXPOSURE=nan\n\n-Y 1 +X 1\n" + pixel), ExitCode::kInvalid, "EXPOSURE=nan");
    expectRefused(bytesOf("#?RADIANCE\nCOLORCORR=1 2\n\n-Y 1 +X 1\n" + pixel), ExitCode::kInvalid, "COLORCORR=1 2");
    for (const char* size :
         {"-Y 1 -Y 1", "-Y 1", "-Y 1 +X 1 5", "Y 1 X 1", "-Y one +X 1", "", "-Y 1 *X 1", "-Z 1 +X 1"})
        expectRefused(bytesOf(kHead + size + "\n" + pixel), ExitCode::kInvalid, "where its size should be");
    expectRefused(bytesOf(kHead + "-Y 0 +X 1\n" + pixel), ExitCode::kInvalid, "side of 0");
    expectRefused(bytesOf(kHead + "-Y -5 +X 1\n" + pixel), ExitCode::kInvalid, "side of -5");
    expectRefused(bytesOf(kHead + "-Y 100000 +X 1\n" + pixel), ExitCode::kUnsupported, "side of 100000");
    expectRefused(bytesOf(kHead + "-Y 99999999999999999999 +X 1\n" + pixel), ExitCode::kUnsupported, "side of 99999");
    expectRefused(bytesOf(kHead + "-Y 65536 +X 65536\n" + pixel), ExitCode::kUnsupported, "pixels");
    expectRefused(bytesOf(kHead + "-Y 60000 +X 8000\n" + pixel), ExitCode::kInvalid,
                  "cut off"); // before memory is taken
}

TEST(Hdr, BadRunsAreRefused)
{
    const std::string head = kHead + "-Y 1 +X 8\n", pixel = {9, 9, 9, char(130)}, fill(64, 1);
    const std::string row = {2, 2, 0, 8};
    expectRefused(bytesOf(head + row + char(0) + fill), ExitCode::kInvalid, "run of no pixels");
    expectRefused(bytesOf(head + row + char(128 + 9) + fill), ExitCode::kInvalid, "beyond its end");
    expectRefused(bytesOf(head + row + char(9) + fill), ExitCode::kInvalid, "beyond its end");
    expectRefused(bytesOf(head + std::string{2, 2, 0, 9} + fill), ExitCode::kInvalid, "another length");
    expectRefused(bytesOf(head + std::string{1, 1, 1, 3} + fill), ExitCode::kInvalid, "begins with a repetition");
    expectRefused(bytesOf(head + pixel + std::string{1, 1, 1, 8} + fill), ExitCode::kInvalid, "beyond its end");
    std::string long_zero = pixel;
    for (int i = 0; i < 4; ++i)
        long_zero += {1, 1, 1, 0};
    expectRefused(bytesOf(head + long_zero + fill), ExitCode::kInvalid, "beyond its end");
}

TEST(Hdr, EveryTruncationIsRefused)
{
    for (const HdrRuns runs : {HdrRuns::kFlat, HdrRuns::kOld, HdrRuns::kNew})
    {
        const std::vector<std::byte> whole = writeHdr(exactHdrImage(32, 16, 5), {.runs = runs});
        for (size_t size = 0; size < whole.size(); ++size)
        {
            Collected collected;
            ASSERT_FALSE(readHdr(std::span(whole).first(size), collected)) << size << " of " << whole.size();
        }
    }
}

/// Each reads at most as many pixels as its header states, so that none can last.
TEST(Hdr, ChangedBytesGiveAnErrorOrAPicture)
{
    std::minstd_rand random(11);
    size_t read = 0, refused = 0;
    for (const HdrRuns runs : {HdrRuns::kFlat, HdrRuns::kOld, HdrRuns::kNew})
        for (int i = 0; i < 1000; ++i)
        {
            std::vector<std::byte> file = writeHdr(exactHdrImage(32, 16, uint32_t(i)), {.runs = runs});
            for (uint32_t k = 0; k <= random() % 4; ++k)
                file[random() % file.size()] = std::byte(random());
            Collected collected;
            const Status status = readHdr(file, collected);
            ++(status ? read : refused);
            ASSERT_TRUE(status || status.error().message.find('\n') == std::string::npos);
        }
    EXPECT_GT(read, 0u);
    EXPECT_GT(refused, 0u);
}
} // namespace
