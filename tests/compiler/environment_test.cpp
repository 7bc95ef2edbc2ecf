// Environment maps: files good and bad, and an importance grid that follows the filtered radiance.
#include "compiler/environment.h"
#include "compiler/vector_math.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <random>

namespace
{
namespace fs = std::filesystem;

constexpr double kPi = std::numbers::pi;

fs::path shared(const char* name)
{
    return fs::path(LUMICUT_SHARED_DIR) / "scenes" / name;
}

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

struct TemporaryFile
{
    fs::path path;
    explicit TemporaryFile(const std::string& suffix)
        : path(fs::temp_directory_path() / ("lumicut-env-" + std::to_string(getpid()) + suffix))
    {
    }
    ~TemporaryFile()
    {
        std::error_code ignored;
        fs::remove(path, ignored);
    }
};

/// 3 x 2 texels, float, with a data window that does not start at 0.
void writeExr(const fs::path& path, const std::vector<const char*>& channels, const std::vector<float>& values)
{
    Imf::Header header(Imath::Box2i({-1, 5}, {1, 6}), Imath::Box2i({-1, 5}, {1, 6}));
    Imf::FrameBuffer frame;
    for (size_t c = 0; c < channels.size(); ++c)
    {
        header.channels().insert(channels[c], Imf::Channel(Imf::FLOAT));
        char* base = const_cast<char*>(reinterpret_cast<const char*>(values.data() + c * 6));
        frame.insert(channels[c], Imf::Slice(Imf::FLOAT, base + 4 - 5 * 12, 4, 12));
    }
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(2);
}

void expectError(const fs::path& path, ExitCode code, const std::string& words)
{
    const auto image = loadEnvironment(path);
    ASSERT_FALSE(image) << path;
    EXPECT_EQ(image.error().code, code) << image.error().message;
    EXPECT_NE(image.error().message.find(words), std::string::npos) << image.error().message;
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

TEST(LoadEnvironment, ReadsFloatExrWithAnOffsetWindow)
{
    const TemporaryFile file(".exr");
    std::vector<float> values;
    for (int i = 0; i < 18; ++i)
        values.push_back(1.0001f + float(i)); // more digits than a half holds
    values[3] = -2;
    writeExr(file.path, {"R", "G", "B"}, values);
    const auto image = loadEnvironment(file.path);
    ASSERT_TRUE(image) << image.error().message;
    ASSERT_EQ(image->width, 3u);
    ASSERT_EQ(image->height, 2u);
    EXPECT_EQ(image->texels[5].x, values[5]);
    EXPECT_EQ(image->texels[0].y, values[6]);
    EXPECT_EQ(image->texels[4].z, values[16]);
    EXPECT_EQ(image->texels[3].x, 0) << "negative radiance becomes 0";
}

TEST(LoadEnvironment, ReadsLuminanceExrAsGrey)
{
    const TemporaryFile file(".exr");
    writeExr(file.path, {"Y"}, {1, 2, 3, 4, 5, 6});
    const auto image = loadEnvironment(file.path);
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_EQ(image->texels[4].x, 5);
    EXPECT_EQ(image->texels[4].z, 5);
}

TEST(LoadEnvironment, ExplainsWhatItCannotRead)
{
    expectError("/nowhere/sky.exr", ExitCode::kIo, "No such file");
    expectError(fs::temp_directory_path() / "sky.png", ExitCode::kUnsupported, ".hdr");
    const TemporaryFile hdr(".hdr");
    std::ofstream(hdr.path) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 3\n";
    expectError(hdr.path, ExitCode::kInvalid, "cannot be read");
    const TemporaryFile exr(".exr");
    std::ofstream(exr.path) << "not an exr";
    expectError(exr.path, ExitCode::kInvalid, "cannot be read");
    const TemporaryFile depth(".EXR");
    writeExr(depth.path, {"Z"}, {1, 2, 3, 4, 5, 6});
    expectError(depth.path, ExitCode::kInvalid, "channels R, G, B");
}

TEST(LoadEnvironment, ReadsRadianceHdr)
{
    const TemporaryFile file(".hdr");
    const std::string rgbe = {char(128), 64, 32, char(129), 0, 0, 0, 0, 16, 16, 16, char(136), 1, 2, 3, char(137)};
    std::ofstream(file.path, std::ios::binary) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n" << rgbe;
    const auto image = loadEnvironment(file.path);
    ASSERT_TRUE(image) << image.error().message;
    ASSERT_EQ(image->width, 2u);
    ASSERT_EQ(image->height, 2u);
    const std::vector<float> wanted{1, 0.5f, 0.25f, 0, 0, 0, 16, 16, 16, 2, 4, 6}; // mantissa x 2^(exponent - 136)
    for (size_t i = 0; i < 4; ++i)
    {
        EXPECT_EQ(image->texels[i].x, wanted[3 * i]);
        EXPECT_EQ(image->texels[i].y, wanted[3 * i + 1]);
        EXPECT_EQ(image->texels[i].z, wanted[3 * i + 2]);
    }
}

TEST(LoadEnvironment, ReadsSharedMaps)
{
    if (!fs::exists(shared("env")))
        GTEST_SKIP() << "shared scenes not found";
    for (const auto& entry : fs::directory_iterator(shared("env")))
    {
        const auto image = loadEnvironment(entry.path());
        ASSERT_TRUE(image) << entry.path() << image.error().message;
        EXPECT_EQ(image->width, 2 * image->height) << entry.path();
        EXPECT_GT(luminance(averageRadiance(*image)), 0) << entry.path();
    }
}

TEST(LoadEnvironment, NamesNanInSharedImage)
{
    if (!fs::exists(shared("exr")))
        GTEST_SKIP() << "shared scenes not found";
    const auto image = loadEnvironment(shared("exr/BrightRingsNanInf.exr"));
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().code, ExitCode::kInvalid);
    EXPECT_TRUE(image.error().message.find("NaN") != std::string::npos ||
                image.error().message.find("infinite") != std::string::npos)
        << image.error().message;
}

TEST(LoadEnvironment, DamagedSharedImagesGiveAnErrorOrAnImage)
{
    if (!fs::exists(shared("negative/exr-damaged")))
        GTEST_SKIP() << "shared scenes not found";
    size_t errors = 0;
    for (const auto& entry : fs::recursive_directory_iterator(shared("negative/exr-damaged")))
    {
        if (!entry.is_regular_file())
            continue;
        const fs::path link = fs::temp_directory_path() / ("lumicut-damaged-" + std::to_string(getpid()) + ".exr");
        std::error_code ignored;
        fs::remove(link, ignored);
        fs::create_symlink(entry.path(), link); // the files have no suffix
        const auto image = loadEnvironment(link);
        fs::remove(link, ignored);
        if (image)
            continue;
        ++errors;
        EXPECT_GT(image.error().message.size(), 20u) << entry.path();
        EXPECT_EQ(image.error().message.find('\n'), std::string::npos) << entry.path();
    }
    EXPECT_GT(errors, 0u);
}
