// Environment maps from files: repairs, scale, reduction of large ones, cube maps, and whose fault an error is.
#include "compiler/cube_map.h"
#include "compiler/environment.h"
#include "compiler/environment_map.h"
#include "compiler/environment_sink.h"
#include "compiler/vector_math.h"
#include "tests/image/exr_writer.h"
#include "tests/image/hdr_writer.h"
#include "tests/tools/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <unistd.h>

namespace
{
namespace fs = std::filesystem;

fs::path shared(const char* name)
{
    return fs::path(LUMICUT_SHARED_DIR) / "scenes" / name;
}

std::vector<std::byte> exrOf(int width, int height, const std::function<float(int, int)>& value)
{
    return writeExr({{.data = window(0, 0, width, height),
                      .display = window(0, 0, width, height),
                      .channels = rgbChannels(value)}});
}

LoadedEnvironment decoded(const std::vector<std::byte>& exr, float scale = 1)
{
    Result<LoadedEnvironment> loaded = decodeExrEnvironment(exr, "sky.exr", scale);
    EXPECT_TRUE(loaded) << (loaded ? "" : loaded.error().message);
    return loaded ? *loaded : LoadedEnvironment();
}

/// Passes `image` to a sink, row by row.
void feed(EnvironmentSink& sink, const ImageF& image)
{
    ASSERT_TRUE(sink.begin({.width = image.width, .height = image.height, .notes = {}}));
    for (uint32_t y = 0; y < image.height; ++y)
        sink.add({.x = 0,
                  .y = y,
                  .rgb = std::span(image.rgb).subspan(size_t(3) * y * image.width, size_t(3) * image.width)});
}

TEST(EnvironmentMap, ReplacesWhatNoLightCanBeAndCountsIt)
{
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
    const std::array<float, 8> values{1, kNan, kInfinity, -kInfinity, -3, kInfinity, 2, 0};
    const LoadedEnvironment loaded =
        decoded(exrOf(4, 2, [&](int x, int y) { return values[size_t(4 * y + x)]; }), 0.5f);
    const std::array<float, 8> want{0.5f, 0, 32752, 0, 0, 32752, 1, 0};
    for (size_t i = 0; i < want.size(); ++i)
        EXPECT_EQ(loaded.image.texels[i].x, want[i]) << i;
    EXPECT_EQ(loaded.image.texels[6].z, 4) << "blue is four times red, halved";
    EXPECT_EQ(loaded.warnings, (std::vector<std::string>{"environment sky.exr: 1 texel is NaN and became 0",
                                                         "environment sky.exr: 2 texels are infinite and became 65504",
                                                         "environment sky.exr: 2 texels are negative and became 0"}));
}

TEST(EnvironmentMap, OfAnySizeIsRead)
{
    for (const auto& [width, height] : {std::pair{1, 1}, {3, 1}, {1, 7}, {17, 9}, {100, 100}})
    {
        const LoadedEnvironment loaded =
            decoded(exrOf(width, height, [](int x, int y) { return float(1 + x + 10 * y); }));
        ASSERT_EQ(loaded.image.texels.size(), size_t(width * height));
        EXPECT_EQ(loaded.image.texels.back().x, float(width + 10 * (height - 1)));
        EXPECT_EQ(loaded.warnings.size(), height >= 7 && height != 9 ? 1u : 0u) << "hardly maps of this kind";
    }
}

/// The mean over the sphere is that of the texels as they were; a constant stays.
TEST(EnvironmentMap, LargeOnesAreAveragedOverSolidAngle)
{
    for (const auto& [width, height] : {std::pair{20000u, 3u}, {5u, 9000u}, {8193u, 2u}, {16384u, 5u}})
    {
        std::mt19937 random(width);
        ImageF image{width, height, std::vector<float>(3 * size_t(width) * height)};
        for (float& value : image.rgb)
            value = random() % 10 == 0 ? float(random() % 1000) : 0;
        for (size_t i = 2; i < image.rgb.size(); i += 3)
            image.rgb[i] = 0.3f;
        EnvironmentSink sink(1);
        feed(sink, image);
        ASSERT_EQ(sink.image.width, std::min(width, kMaxEnvironmentWidth));
        ASSERT_EQ(sink.image.height, std::min(height, kMaxEnvironmentHeight));
        EnvironmentImage whole{.width = width, .height = height, .texels = {}};
        for (size_t i = 0; i < image.rgb.size(); i += 3)
            whole.texels.push_back({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2], 1});
        const gpu::vec3 before = averageRadiance(whole), after = averageRadiance(sink.image);
        EXPECT_NEAR(after.x / before.x, 1, 1e-5) << width << " x " << height; // float sums of a few terms a texel
        EXPECT_NEAR(after.y / before.y, 1, 1e-5);
        for (const gpu::vec4& texel : sink.image.texels)
            ASSERT_NEAR(texel.z, 0.3f, 1e-6);
    }
}

TEST(EnvironmentMap, ReductionIsTheMeanOfWhatATexelCovers)
{
    ImageF image{2 * kMaxEnvironmentWidth, 1, {}};
    for (uint32_t x = 0; x < image.width; ++x)
        image.rgb.insert(image.rgb.end(), {float(x), x % 2 == 0 ? 4.0f : 0.0f, 1});
    EnvironmentSink sink(3);
    feed(sink, image);
    for (uint32_t x = 0; x < kMaxEnvironmentWidth; x += 97)
    {
        EXPECT_EQ(sink.image.texels[x].x, 3 * (2 * float(x) + 0.5f));
        EXPECT_EQ(sink.image.texels[x].y, 6);
    }
}

/// A field that is linear in the direction is bilinear on no face, but a few pixels are close: the cube's pixels are
/// placed by OpenEXR's own definition, the map's by ours.
TEST(EnvironmentMap, CubesKeepTheirDirections)
{
    constexpr int kSide = 64;
    const Imath::Box2i box = window(0, 0, kSide, 6 * kSide);
    const auto component = [&](int axis)
    {
        return [=](int x, int y)
        {
            const Imf::CubeMapFace face = Imf::CubeMapFace(y / kSide);
            // The position in a face whose pixel this is: the library mirrors and turns some.
            for (const auto& [fx, fy] : {std::pair{x, y % kSide},
                                         {x, kSide - 1 - y % kSide},
                                         {kSide - 1 - x, y % kSide},
                                         {kSide - 1 - x, kSide - 1 - y % kSide},
                                         {y % kSide, x},
                                         {y % kSide, kSide - 1 - x},
                                         {kSide - 1 - y % kSide, x},
                                         {kSide - 1 - y % kSide, kSide - 1 - x}})
            {
                const Imath::V2f in_face{float(fx), float(fy)};
                const Imath::V2f at = Imf::CubeMap::pixelPosition(face, box, in_face);
                if (int(std::lround(at.x)) == x && int(std::lround(at.y)) == y)
                    return 2 + Imf::CubeMap::direction(face, box, in_face).normalized()[axis];
            }
            return -1.0f;
        };
    };
    const ExrPart part{.data = box,
                       .display = box,
                       .channels = {{.name = "R", .value = component(0)},
                                    {.name = "G", .value = component(1)},
                                    {.name = "B", .value = component(2)}},
                       .envmap = Imf::ENVMAP_CUBE};
    const LoadedEnvironment loaded = decoded(writeExr({part}));
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_NE(loaded.warnings[0].find("cube map"), std::string::npos);
    const EnvironmentImage& map = loaded.image;
    ASSERT_EQ(map.width, 4u * kSide);
    ASSERT_EQ(map.height, 2u * kSide);
    for (uint32_t y = 0; y < map.height; ++y)
        for (uint32_t x = 0; x < map.width; ++x)
        {
            const double phi = ((x + 0.5) / map.width - 0.5) * 2 * std::numbers::pi,
                         theta = (y + 0.5) / map.height * std::numbers::pi;
            const gpu::vec4& texel = map.texels[size_t(y) * map.width + x];
            // Second derivatives of at most 2 over a quarter of a pixel's or texel's width squared.
            constexpr double kCurvature = 2 * 2.0 / kSide * 2.0 / kSide / 4;
            ASSERT_NEAR(texel.x, 2 + std::sin(theta) * std::cos(phi), kCurvature) << x << ", " << y;
            ASSERT_NEAR(texel.y, 2 + std::cos(theta), kCurvature) << x << ", " << y;
            ASSERT_NEAR(texel.z, 2 + std::sin(theta) * std::sin(phi), kCurvature) << x << ", " << y;
        }
}

TEST(EnvironmentMap, OfOneCubePixelIsAMeanOfFaces)
{
    EnvironmentImage cube{.width = 1, .height = 6, .texels = {}};
    for (int face = 0; face < 6; ++face)
        cube.texels.push_back({float(face), 0, 0, 1});
    const EnvironmentImage map = toEquirectangular(cube);
    ASSERT_EQ(map.texels.size(), 8u);
    // The row above the horizon looks 22.5 degrees and 67.5 degrees up, in columns about +-135 and +-45 degrees from
    // +X.
    for (uint32_t x = 0; x < 4; ++x)
    {
        EXPECT_TRUE(map.texels[x].x > 0 && map.texels[x].x < 4.5f) << map.texels[x].x;
        EXPECT_NEAR(map.texels[x + 4].x - map.texels[x].x, 0.5, 1e-6) << "half of it -Y in the place of +Y";
    }
}

TEST(LoadEnvironment, ErrorsNameTheMap)
{
    const TemporaryFolder folder;
    const auto expect = [&](const fs::path& path, ExitCode code, const std::string& words)
    {
        const auto loaded = loadEnvironment(path);
        ASSERT_FALSE(loaded) << path;
        EXPECT_EQ(int(loaded.error().code), int(code)) << loaded.error().message;
        EXPECT_EQ(loaded.error().file, path.string());
        EXPECT_NE(loaded.error().message.find(words), std::string::npos) << loaded.error().message;
    };
    std::ofstream(folder / "text.exr") << "not an exr";
    std::ofstream(folder / "text.hdr") << "not an hdr";
    std::ofstream(folder / "empty.HDR");
    fs::create_directory(folder / "folder.exr");
    expect(folder / "none.exr", ExitCode::kIo, "No such file");
    expect(folder / "sky.png", ExitCode::kUnsupported, ".hdr");
    expect(folder / "text.exr", ExitCode::kInvalid, "OpenEXR");
    expect(folder / "text.hdr", ExitCode::kInvalid, "Radiance");
    expect(folder / "empty.HDR", ExitCode::kInvalid, "empty");
    expect(folder / "folder.exr", ExitCode::kIo, "directory");
}

TEST(LoadEnvironment, ReadsHdrFilesAndScalesThem)
{
    const TemporaryFolder folder;
    const ImageF image = exactHdrImage(32, 16, 4);
    const std::vector<std::byte> file = writeHdr(image);
    std::ofstream(folder / "sky.HDR", std::ios::binary)
        .write(reinterpret_cast<const char*>(file.data()), std::streamsize(file.size()));
    const auto loaded = loadEnvironment(folder / "sky.HDR", 2);
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_TRUE(loaded->warnings.empty());
    for (size_t i = 0; i < loaded->image.texels.size(); ++i)
        ASSERT_EQ(loaded->image.texels[i].y, 2 * image.rgb[3 * i + 1]);
}

TEST(LoadEnvironment, ReadsSharedMaps)
{
    if (!fs::exists(shared("env")))
        GTEST_SKIP() << "shared scenes not found";
    for (const auto& entry : fs::directory_iterator(shared("env")))
    {
        const auto loaded = loadEnvironment(entry.path());
        ASSERT_TRUE(loaded) << entry.path() << loaded.error().message;
        EXPECT_EQ(loaded->image.width, 2 * loaded->image.height) << entry.path();
        EXPECT_GT(luminance(averageRadiance(loaded->image)), 0) << entry.path();
    }
}

TEST(LoadEnvironment, DamagedSharedImagesGiveAnErrorOrAnImage)
{
    if (!fs::exists(shared("negative/exr-damaged")))
        GTEST_SKIP() << "shared scenes not found";
    const TemporaryFolder folder;
    size_t errors = 0;
    for (const auto& entry : fs::recursive_directory_iterator(shared("negative/exr-damaged")))
    {
        if (!entry.is_regular_file())
            continue;
        fs::create_symlink(entry.path(), folder / "damaged.exr"); // the files have no suffix
        const auto loaded = loadEnvironment(folder / "damaged.exr");
        fs::remove(folder / "damaged.exr");
        if (loaded)
            continue;
        ++errors;
        EXPECT_GT(loaded.error().message.size(), 20u) << entry.path();
        EXPECT_EQ(loaded.error().message.find('\n'), std::string::npos) << entry.path();
    }
    EXPECT_GT(errors, 0u);
}
} // namespace
