// OpenEXR pictures: windows, tiles, layers, parts, luminance, chromaticities, kinds of environment maps; damage.
#include "image/read_exr.h"
#include "tests/image/collect.h"
#include "tests/image/exr_writer.h"

#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

namespace
{
float pattern(int x, int y)
{
    return 1.0001f + float(x) + 100 * float(y); // more digits than a half holds
}

Collected readBack(const std::vector<std::byte>& file)
{
    Collected collected;
    const Status status = readExr(file, collected);
    EXPECT_TRUE(status) << (status ? "" : status.error().message);
    return collected;
}

void expectRefused(const std::vector<std::byte>& file, ExitCode code, const std::string& words)
{
    Collected collected;
    const Status status = readExr(file, collected);
    ASSERT_FALSE(status);
    EXPECT_EQ(int(status.error().code), int(code)) << status.error().message;
    EXPECT_NE(status.error().message.find(words), std::string::npos) << status.error().message;
}

/// Pixel (x, y) of the display window holds the pattern of its place where that is in `data`, else black.
void expectPattern(const Collected& picture, const Imath::Box2i& data, const Imath::Box2i& display)
{
    ASSERT_EQ(int(picture.image.width), display.max.x - display.min.x + 1);
    ASSERT_EQ(int(picture.image.height), display.max.y - display.min.y + 1);
    for (int y = display.min.y; y <= display.max.y; ++y)
        for (int x = display.min.x; x <= display.max.x; ++x)
        {
            const float want = data.intersects(Imath::V2i(x, y)) ? pattern(x, y) : 0;
            const float* rgb = picture.at(uint32_t(x - display.min.x), uint32_t(y - display.min.y));
            ASSERT_EQ(rgb[0], want) << x << ", " << y;
            ASSERT_EQ(rgb[1], 2 * want);
            ASSERT_EQ(rgb[2], 4 * want);
        }
}

const Imath::Box2i kWindow = window(0, 0, 8, 4);

TEST(ExrPicture, IsTheDisplayWindowWhateverIsStored)
{
    const Imath::Box2i display = window(3, -2, 40, 20);
    for (const Imath::Box2i& data :
         {display, window(3, -2, 40, 10), window(-30, -40, 100, 90), window(10, 5, 7, 3), window(20, 10, 90, 3),
          window(-90, 3, 95, 1), window(500, 500, 4, 4), window(3, 40, 40, 5)})
        for (const bool tiled : {false, true})
        {
            ExrPart part{.data = data, .display = display, .channels = rgbChannels(pattern)};
            if (tiled)
                part.tiles = Imf::TileDescription(8, 4, Imf::ONE_LEVEL);
            expectPattern(readBack(writeExr({part})), data, display);
        }
}

TEST(ExrPicture, IsLevel0OfTiles)
{
    const Imath::Box2i box = window(-5, 7, 50, 37);
    for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS, Imf::RIPMAP_LEVELS})
        for (const Imath::V2i& size : {Imath::V2i(16, 16), {64, 3}, {7, 64}})
        {
            const ExrPart part{.data = box,
                               .display = box,
                               .channels = rgbChannels(pattern),
                               .tiles = Imf::TileDescription(unsigned(size.x), unsigned(size.y), mode)};
            expectPattern(readBack(writeExr({part})), box, box);
        }
}

/// 600 lines are more than are read at once.
TEST(ExrPicture, ReadsEveryLosslessCompression)
{
    const Imath::Box2i data = window(1, 2, 9, 600), display = window(0, 10, 12, 580);
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION})
        expectPattern(
            readBack(writeExr(
                {{.data = data, .display = display, .channels = rgbChannels(pattern), .compression = compression}})),
            data, display);
}

TEST(ExrPicture, ReadsLossyCompressionsToTheirAccuracy)
{
    const Imath::Box2i box = window(0, 0, 64, 300);
    for (const Imf::Compression compression : {Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION,
                                               Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION})
    {
        auto channels = rgbChannels([](int, int y) { return 1 + float(y) / 300; });
        for (ExrChannel& channel : channels)
            channel.half = true; // of floats some of these keep everything
        const Collected picture =
            readBack(writeExr({{.data = box, .display = box, .channels = channels, .compression = compression}}));
        for (uint32_t y = 0; y < 300; ++y)
            ASSERT_NEAR(picture.at(5, y)[1] / (2 + float(y) / 150), 1, 0.02) << int(compression) << ", row " << y;
    }
}

TEST(ExrPicture, TakesTheChannelsWithoutALayerOrTheFirstLayerWithColour)
{
    const auto withLayers = [](std::vector<std::vector<ExrChannel>> lists)
    {
        ExrPart part{.data = kWindow, .display = kWindow, .channels = {}};
        for (const auto& list : lists)
            part.channels.insert(part.channels.end(), list.begin(), list.end());
        return readBack(writeExr({part}));
    };
    const auto other = rgbChannels([](int, int) { return 9.0f; }, "a.diffuse.");
    const std::vector<ExrChannel> depth{
        {.name = "Z", .value = pattern}, {.name = "A", .value = pattern}, {.name = "a.Z", .value = pattern}};

    const Collected plain = withLayers({rgbChannels(pattern), depth});
    expectPattern(plain, kWindow, kWindow);
    EXPECT_TRUE(plain.info.notes.empty());

    const Collected with_default = withLayers({other, rgbChannels(pattern)});
    expectPattern(with_default, kWindow, kWindow);
    ASSERT_EQ(with_default.info.notes.size(), 1u);
    EXPECT_NE(with_default.info.notes[0].find("without a layer"), std::string::npos);

    const Collected layered = withLayers(
        {depth, rgbChannels([](int, int) { return 9.0f; }, "view.z."), rgbChannels(pattern, "view.combined.")});
    expectPattern(layered, kWindow, kWindow);
    ASSERT_EQ(layered.info.notes.size(), 1u);
    EXPECT_NE(layered.info.notes[0].find("of 2 with colour \"view.combined\""), std::string::npos)
        << layered.info.notes[0];
}

TEST(ExrPicture, TakesTheFirstPartWithColour)
{
    const ExrPart depth{
        .data = kWindow, .display = kWindow, .channels = {{.name = "Z", .value = pattern}}, .name = "depth"};
    ExrPart deep = depth;
    deep.deep = true;
    deep.name = "deep";
    const ExrPart colour{.data = kWindow,
                         .display = kWindow,
                         .channels = rgbChannels(pattern),
                         .tiles = Imf::TileDescription(4, 4, Imf::MIPMAP_LEVELS),
                         .name = "beauty"};
    ExrPart second = colour;
    second.channels = rgbChannels([](int, int) { return 9.0f; });
    second.name = "second";
    const Collected picture = readBack(writeExr({depth, deep, colour, second}));
    expectPattern(picture, kWindow, kWindow);
    ASSERT_EQ(picture.info.notes.size(), 1u);
    EXPECT_NE(picture.info.notes[0].find("4 parts: part 2 is read, \"beauty\""), std::string::npos)
        << picture.info.notes[0];
    expectRefused(writeExr({deep}), ExitCode::kUnsupported, "deep pixels");
}

TEST(ExrPicture, LuminanceAloneIsGrey)
{
    const Collected picture = readBack(
        writeExr({{.data = kWindow,
                   .display = kWindow,
                   .channels = {{.name = "Y", .value = pattern}},
                   .chromaticities = Imf::Chromaticities({0.7f, 0.3f}, {0.2f, 0.8f}, {0.1f, 0.05f}, {0.4f, 0.4f})}}));
    for (uint32_t c = 0; c < 3; ++c)
        EXPECT_EQ(picture.at(3, 2)[c], pattern(3, 2));
}

/// Chroma that is linear between the samples is restored exactly; the written file is the definition's own inverse.
TEST(ExrPicture, LuminanceAndChromaBecomeRgb)
{
    const auto red = [](int x, int y) { return 1 + 0.25f * float(x) + 0.125f * float(y); };
    const auto blue = [](int x, int y) { return 3 - 0.125f * float(x) + 0.25f * float(y); };
    for (const int sampling : {1, 2})
    {
        const ExrPart part{
            .data = window(4, 2, 20, 10),
            .display = window(4, 2, 19, 9), // of a pixel beyond the last sample none interpolates
            .channels = {
                {.name = "Y", .value = [](int, int) { return 2.0f; }},
                {.name = "RY", .value = [&](int x, int y) { return red(x, y) / 2 - 1; }, .sampling = sampling},
                {.name = "BY", .value = [&](int x, int y) { return blue(x, y) / 2 - 1; }, .sampling = sampling}}};
        const Collected picture = readBack(writeExr({part}));
        for (int y = 2; y < 11; ++y)
            for (int x = 4; x < 23; ++x)
            {
                const float* rgb = picture.at(uint32_t(x - 4), uint32_t(y - 2));
                ASSERT_NEAR(rgb[0], red(x, y), 1e-5) << x << ", " << y;
                ASSERT_NEAR(rgb[2], blue(x, y), 1e-5);
                ASSERT_NEAR(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2], 2,
                            5e-4); // weights of four digits, sums up to 10
            }
    }
}

/// Written by the library's own conversion.
TEST(ExrPicture, ReadsWhatTheLibraryWritesAsLuminanceAndChroma)
{
    Imf::StdOSStream stream;
    std::vector<Imf::Rgba> pixels(size_t(32 * 16), Imf::Rgba(0.5f, 2, 1));
    {
        Imf::RgbaOutputFile file(stream, Imf::Header(32, 16), Imf::WRITE_YC);
        file.setYCRounding(10, 10); // bits: all of a half's
        file.setFrameBuffer(pixels.data(), 1, 32);
        file.writePixels(16);
    }
    const std::string text = stream.str();
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    const Collected picture = readBack({bytes, bytes + text.size()});
    const std::array<float, 3> want{0.5f, 2, 1};
    for (size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(picture.at(7, 7)[c], want[c], 4e-3); // a few roundings to 2^-10 of values up to 2
}

TEST(ExrPicture, ConvertsChromaticities)
{
    ExrPart part{.data = kWindow,
                 .display = kWindow,
                 .channels = rgbChannels([](int, int) { return 1.0f; }),
                 .chromaticities =
                     Imf::Chromaticities({0.708f, 0.292f}, {0.170f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.3290f})};
    const Collected picture = readBack(writeExr({part}));
    const float* rgb = picture.at(0, 0); // of (1, 2, 4), by the matrix of ITU-R BT.2407
    EXPECT_NEAR(rgb[0], 1.6605 - 2 * 0.5876 - 4 * 0.0728, 5e-4);
    EXPECT_NEAR(rgb[1], -0.1246 + 2 * 1.1329 - 4 * 0.0083, 5e-4);
    EXPECT_NEAR(rgb[2], -0.0182 - 2 * 0.1006 + 4 * 1.1187, 5e-4);
}

TEST(ExrPicture, KnowsCubesByTheirAttribute)
{
    ExrPart part{.data = window(2, 3, 4, 24),
                 .display = window(0, 0, 3, 3),
                 .channels = rgbChannels(pattern),
                 .envmap = Imf::ENVMAP_CUBE};
    const Collected cube = readBack(writeExr({part}));
    EXPECT_TRUE(cube.info.cube);
    expectPattern(cube, part.data, part.data);
    part.data = part.display = window(0, 0, 8, 4);
    expectRefused(writeExr({part}), ExitCode::kInvalid, "six square faces");
    part.envmap = Imf::ENVMAP_LATLONG;
    const Collected map = readBack(writeExr({part}));
    EXPECT_FALSE(map.info.cube);
    expectPattern(map, part.data, part.data);
    part.envmap.reset();
    part.text_envmap = "angular";
    expectRefused(writeExr({part}), ExitCode::kUnsupported, "envmap");
}

TEST(ExrPicture, WhatHasNoColourOrNoSizeIsRefused)
{
    expectRefused({}, ExitCode::kInvalid, "not an OpenEXR");
    expectRefused(writeExr({{.data = kWindow, .display = kWindow, .channels = {{.name = "Z", .value = pattern}}}}),
                  ExitCode::kInvalid, "channels Z");
    expectRefused(writeExr({{.data = kWindow, .display = window(0, 0, 100000, 2), .channels = rgbChannels(pattern)}}),
                  ExitCode::kUnsupported, "display window");
    expectRefused(writeExr({{.data = window(1 << 25, 0, 2, 2), .display = kWindow, .channels = rgbChannels(pattern)}}),
                  ExitCode::kInvalid, "from 0");
}

/// The library reads a value by its type, whatever size the file states, and would take what follows for something else: lengths of
/// gigabytes among them.
TEST(ExrPicture, AttributesOfAnotherLengthThanTheirTypesAreRefused)
{
    const std::vector<std::byte> whole =
        writeExr({{.data = kWindow, .display = kWindow, .channels = rgbChannels(pattern)}});
    for (const std::string type : {"chlist", "compression", "box2i", "lineOrder", "float", "v2f"})
    {
        std::vector<std::byte> file = whole;
        const std::string text = type + '\0'; // the last of them: an attribute may be named as its type
        const auto found = std::find_end(file.begin(), file.end(), text.begin(), text.end(),
                                         [](std::byte a, char b) { return a == std::byte(b); });
        ASSERT_NE(found, file.end()) << type;
        std::byte& size = *(found + ptrdiff_t(text.size()));
        size = std::byte(uint8_t(size) + 1);
        expectRefused(file, ExitCode::kInvalid, "type " + type);
    }
}

/// A tile as large as a picture may be, in a file of some hundred bytes.
TEST(ExrPicture, ATileThatNoFileOfThatSizeHoldsIsRefused)
{
    ExrPart part{.data = kWindow, .display = kWindow, .channels = rgbChannels(pattern)};
    part.tiles = Imf::TileDescription(64, 64, Imf::ONE_LEVEL);
    std::vector<std::byte> file = writeExr({part});
    const std::string type = std::string("tiledesc") + '\0';
    const auto found = std::search(file.begin(), file.end(), type.begin(), type.end(),
                                   [](std::byte a, char b) { return a == std::byte(b); });
    ASSERT_NE(found, file.end());
    const uint32_t side = 10000;
    std::byte* sizes = &*found + type.size() + sizeof(uint32_t);
    for (int i = 0; i < 2; ++i)
        std::memcpy(sizes + i * sizeof(side), &side, sizeof(side));
    expectRefused(file, ExitCode::kUnsupported, "10000 x 10000");
}

std::vector<std::byte> damageable(bool tiled, Imf::Compression compression)
{
    ExrPart part{.data = window(0, 0, 24, 18),
                 .display = window(-1, 0, 24, 18),
                 .channels = rgbChannels(pattern),
                 .compression = compression};
    if (tiled)
        part.tiles = Imf::TileDescription(8, 8, Imf::MIPMAP_LEVELS);
    return writeExr({part});
}

/// Of tiles level 0 may be there although smaller levels are cut off.
TEST(ExrPicture, ATruncatedFileIsRefusedOrWhole)
{
    for (const bool tiled : {false, true})
    {
        const std::vector<std::byte> whole = damageable(tiled, Imf::ZIP_COMPRESSION);
        const ImageF picture = readBack(whole).image;
        size_t refused = 0, tried = 0;
        for (size_t size = 0; size < whole.size(); size += 1 + size / 40, ++tried)
        {
            Collected collected;
            const Status status =
                readExr(std::vector<std::byte>(whole.begin(), whole.begin() + ptrdiff_t(size)), collected);
            refused += !status;
            ASSERT_TRUE(!status || (tiled && collected.image.rgb == picture.rgb)) << size << " of " << whole.size();
        }
        EXPECT_GT(refused, 3 * tried / 4);
    }
}

TEST(ExrPicture, ChangedBytesGiveAnErrorOrAPicture)
{
    std::minstd_rand random(13);
    size_t read = 0, refused = 0;
    for (const bool tiled : {false, true})
        for (const Imf::Compression compression :
             {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION})
        {
            const std::vector<std::byte> whole = damageable(tiled, compression);
            for (int i = 0; i < 150; ++i)
            {
                std::vector<std::byte> file = whole;
                for (uint32_t k = 0; k <= random() % 4; ++k)
                    file[random() % (i % 2 == 0 ? 400 : file.size())] = std::byte(random());
                Collected collected;
                const Status status = readExr(file, collected);
                ++(status ? read : refused);
                ASSERT_TRUE(status || status.error().message.find('\n') == std::string::npos);
            }
        }
    EXPECT_GT(read, 0u);
    EXPECT_GT(refused, 0u);
}
} // namespace
