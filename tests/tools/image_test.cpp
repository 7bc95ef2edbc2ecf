// Reading and writing pictures.
#include "image/read_exr.h"
#include "image/write_image.h"
#include "tests/tools/random_image.h"
#include "tests/tools/temporary_folder.h"

#include <gtest/gtest.h>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <stb_image.h>

#include <limits>

namespace
{

/// Writes `values` (one channel per name, all the same) with OpenEXR itself.
void writeChannels(const std::filesystem::path& path, const std::vector<std::string>& names,
                   Imf::Compression compression, int width, int height, std::vector<float> values)
{
    Imf::Header header(width, height);
    header.compression() = compression;
    Imf::FrameBuffer source;
    for (const std::string& name : names)
    {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        source.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float),
                                       sizeof(float) * size_t(width)));
    }
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(source);
    file.writePixels(height);
}

void expectError(const Result<ImageF>& result, ExitCode code, const std::string& words)
{
    ASSERT_FALSE(result);
    EXPECT_EQ(int(result.error().code), int(code)) << result.error().message;
    EXPECT_NE(result.error().message.find(words), std::string::npos) << result.error().message;
}

TEST(Exr, RoundTripKeepsEveryBit)
{
    const TemporaryFolder folder;
    ImageF image = randomImage(37, 23, 1, 1000.0f);
    image.rgb[0] = std::numeric_limits<float>::infinity();
    image.rgb[4] = -1e-30f;
    image.rgb[8] = std::numeric_limits<float>::denorm_min();
    ASSERT_TRUE(writeExr(folder / "a.exr", image));
    const Result<ImageF> back = readExr(folder / "a.exr");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->width, 37u);
    EXPECT_EQ(back->height, 23u);
    EXPECT_EQ(back->rgb, image.rgb);
}

TEST(Exr, SameImageSameBytes)
{
    const TemporaryFolder folder;
    const ImageF image = randomImage(64, 48, 2);
    ASSERT_TRUE(writeExr(folder / "a.exr", image));
    ASSERT_TRUE(writeExr(folder / "b.exr", image));
    EXPECT_EQ(fileBytes(folder / "a.exr"), fileBytes(folder / "b.exr"));
    EXPECT_FALSE(fileBytes(folder / "a.exr").empty());
}

TEST(Exr, GreyImageFillsAllThreeChannels)
{
    const TemporaryFolder folder;
    writeChannels(folder / "y.exr", {"Y"}, Imf::PIZ_COMPRESSION, 2, 1, {0.25f, 4.0f});
    const Result<ImageF> image = readExr(folder / "y.exr");
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_EQ(image->rgb, (std::vector<float>{0.25f, 0.25f, 0.25f, 4.0f, 4.0f, 4.0f}));
}

TEST(Exr, ReadsEveryLosslessCompressionAndIgnoresOtherChannels)
{
    const TemporaryFolder folder;
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION})
    {
        writeChannels(folder / "c.exr", {"A", "B", "G", "R", "Z"}, compression, 2, 2, {1, 2, 3, 4});
        const Result<ImageF> image = readExr(folder / "c.exr");
        ASSERT_TRUE(image) << image.error().message;
        EXPECT_EQ(image->rgb, (std::vector<float>{1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4})) << int(compression);
    }
}

TEST(Exr, BadInputGetsASentenceAndTheRightCode)
{
    const TemporaryFolder folder;
    expectError(readExr(folder / "none.exr"), ExitCode::kIo, "No such file");
    expectError(readExr(folder.path()), ExitCode::kIo, "directory");

    ASSERT_TRUE(writeFile(folder / "empty.exr", {}));
    expectError(readExr(folder / "empty.exr"), ExitCode::kInvalid, "empty");
    ASSERT_TRUE(writePng(folder / "png.exr", 1, 1, 3, std::vector<uint8_t>{1, 2, 3}));
    expectError(readExr(folder / "png.exr"), ExitCode::kInvalid, "not an OpenEXR");

    writeChannels(folder / "uv.exr", {"u", "v"}, Imf::ZIP_COMPRESSION, 1, 1, {0});
    expectError(readExr(folder / "uv.exr"), ExitCode::kInvalid, "channels u, v");
}

TEST(Exr, EveryTruncationIsRefused)
{
    const TemporaryFolder folder;
    ASSERT_TRUE(writeExr(folder / "whole.exr", randomImage(40, 40, 3)));
    const std::string whole = fileBytes(folder / "whole.exr");
    for (size_t size = 4; size < whole.size(); size += whole.size() / 50)
    {
        ASSERT_TRUE(writeFile(folder / "cut.exr", {reinterpret_cast<const uint8_t*>(whole.data()), size}));
        const Result<ImageF> image = readExr(folder / "cut.exr");
        ASSERT_FALSE(image) << size << " of " << whole.size() << " bytes";
        EXPECT_EQ(int(image.error().code), int(ExitCode::kInvalid));
    }
}

TEST(WriteFile, UnwritablePathsGiveTheReasonAndLeaveNothing)
{
    const TemporaryFolder folder;
    const Status missing = writeExr(folder / "no/such/folder.exr", randomImage(2, 2, 4));
    ASSERT_FALSE(missing);
    EXPECT_EQ(int(missing.error().code), int(ExitCode::kIo));
    EXPECT_NE(missing.error().message.find("No such file or directory"), std::string::npos) << missing.error().message;

    const Status onto_folder = writePng(folder.path(), 1, 1, 1, std::vector<uint8_t>{0});
    ASSERT_FALSE(onto_folder);
    EXPECT_EQ(int(onto_folder.error().code), int(ExitCode::kIo));
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WriteFile, ReplacesAnOlderFileAndLeavesNoTemporary)
{
    const TemporaryFolder folder;
    ASSERT_TRUE(writeFile(folder / "f", std::vector<uint8_t>{'o', 'l', 'd'}));
    ASSERT_TRUE(writeFile(folder / "f", std::vector<uint8_t>{'n', 'e', 'w'}));
    EXPECT_EQ(fileBytes(folder / "f"), "new");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(Png, RoundTripThroughAnotherDecoder)
{
    const std::vector<uint8_t> texels = {255, 0, 0, 0, 255, 0, 1, 2, 3, 250, 251, 252, 7, 8, 9, 128, 127, 126};
    const std::vector<uint8_t> png = encodePng(3, 2, 3, texels);
    int width = 0, height = 0, channels = 0;
    unsigned char* back = stbi_load_from_memory(png.data(), int(png.size()), &width, &height, &channels, 0);
    ASSERT_NE(back, nullptr);
    EXPECT_EQ(width, 3);
    EXPECT_EQ(height, 2);
    EXPECT_EQ(channels, 3);
    EXPECT_EQ(std::vector<uint8_t>(back, back + texels.size()), texels);
    stbi_image_free(back);
}

TEST(Srgb, ByteFollowsTheStandardCurve)
{
    EXPECT_EQ(srgbByte(0.0f), 0);
    EXPECT_EQ(srgbByte(1.0f), 255);
    EXPECT_EQ(srgbByte(7.0f), 255);
    EXPECT_EQ(srgbByte(-1.0f), 0);
    EXPECT_EQ(srgbByte(std::numeric_limits<float>::quiet_NaN()), 0);
    EXPECT_EQ(srgbByte(0.002f), 7);         // linear part: 12.92 * 0.002 * 255 = 6.6
    EXPECT_EQ(srgbByte(0.214041140f), 128); // decodes from 0.5: 127.5 rounds up
}

} // namespace
