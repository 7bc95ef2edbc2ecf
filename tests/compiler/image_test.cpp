#include "compiler/images.h"
#include "tests/compiler/gltf_builder.h"
#include "tests/compiler/ktx2_builder.h"

#include <gtest/gtest.h>
#include <zlib.h>

namespace
{
/// Grey and alpha, 16 bits each.
std::vector<unsigned char> encodePng16(uint32_t width, uint32_t height, const std::vector<uint16_t>& words)
{
    std::vector<unsigned char> png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    const auto put32 = [](std::vector<unsigned char>& to, uint32_t v) {
        to.insert(to.end(), {uint8_t(v >> 24), uint8_t(v >> 16), uint8_t(v >> 8), uint8_t(v)});
    };
    const auto chunk = [&](const char* name, const std::vector<unsigned char>& data)
    {
        put32(png, uint32_t(data.size()));
        std::vector<unsigned char> body(name, name + 4);
        body.insert(body.end(), data.begin(), data.end());
        png.insert(png.end(), body.begin(), body.end());
        put32(png, uint32_t(crc32(0, body.data(), uInt(body.size()))));
    };
    std::vector<unsigned char> header;
    put32(header, width);
    put32(header, height);
    header.insert(header.end(), {16, 4, 0, 0, 0});
    chunk("IHDR", header);
    std::vector<unsigned char> rows;
    for (uint32_t y = 0; y < height; ++y)
    {
        rows.push_back(0); // no filter
        for (uint32_t i = 0; i < 2 * width; ++i)
        {
            rows.push_back(uint8_t(words[2 * width * y + i] >> 8));
            rows.push_back(uint8_t(words[2 * width * y + i]));
        }
    }
    uLongf size = compressBound(uLong(rows.size()));
    std::vector<unsigned char> packed(size);
    compress(packed.data(), &size, rows.data(), uLong(rows.size()));
    packed.resize(size);
    chunk("IDAT", packed);
    chunk("IEND", {});
    return png;
}

/// A scene whose only texture is a file of the given name beside it.
GltfBuilder withTextureFile(const std::string& uri)
{
    GltfBuilder builder;
    builder.json["images"] = {{{"uri", uri}}};
    builder.json["textures"] = {{{"source", 0}}};
    builder.material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    builder.triangle({{"material", 0}});
    return builder;
}

Result<std::vector<DecodedImage>> decode(const GltfBuilder& builder, const TemporaryFolder& folder)
{
    const Result<GltfFile> file = builder.read(folder);
    if (!file)
        return file.error();
    const Result<ImportedScene> imported = importScene(*file);
    if (!imported)
        return imported.error();
    return decodeImages(*file, imported->images);
}

/// Why the only image cannot be read.
Error failure(const std::string& uri, const TemporaryFolder& folder)
{
    const auto images = decode(withTextureFile(uri), folder);
    EXPECT_TRUE(images && images->size() == 1);
    return images && (*images)[0].error ? *(*images)[0].error : Error{ExitCode::kOk, "it was decoded"};
}

TEST(Images, ReadsAPngBesideTheSceneByItsPercentEncodedName)
{
    const std::vector<uint8_t> texels{255, 0, 0, 255, 0, 128, 0, 64};
    const std::vector<unsigned char> png = encodePng(2, 1, texels);
    const TemporaryFolder folder;
    writeBytes(folder / "my texture.png", png.data(), png.size());
    const auto images = decode(withTextureFile("my%20texture.png"), folder);
    ASSERT_TRUE(images) << images.error().message;
    ASSERT_EQ(images->size(), 1u);
    EXPECT_FALSE((*images)[0].error);
    EXPECT_EQ((*images)[0].image.width, 2u);
    EXPECT_EQ((*images)[0].image.texels, texels);
    EXPECT_TRUE((*images)[0].image.srgb);
}

TEST(Images, AMissingFileIsAnInputErrorThatNamesItWithoutItsFolder)
{
    const TemporaryFolder folder;
    const Error error = failure("gone.png", folder);
    EXPECT_EQ(error.code, ExitCode::kIo);
    EXPECT_NE(error.message.find("gone.png"), std::string::npos) << error.message;
    EXPECT_EQ(error.message.find(folder.path().string()), std::string::npos) << error.message;
}

TEST(Images, DamagedOnesAreInvalidAndNamedWithAReason)
{
    const std::vector<unsigned char> png = encodePng(2, 1, {255, 0, 0, 255, 0, 128, 0, 64});
    const std::string webp("RIFF\x10\0\0\0WEBPVP8 nonsense", 24);
    const std::string text = "no picture";
    const std::vector<std::string> contents{std::string(png.begin(), png.begin() + 40),
                                            std::string(png.begin(), png.end() - 12), // without its last chunk
                                            webp,
                                            text,
                                            "\xFF\xD8\xFF",
                                            ""};
    for (const std::string& content : contents)
    {
        const TemporaryFolder folder;
        writeBytes(folder / "bad.png", content.data(), content.size());
        const Error error = failure("bad.png", folder);
        EXPECT_EQ(error.code, ExitCode::kInvalid);
        EXPECT_NE(error.message.find("bad.png"), std::string::npos) << error.message;
        EXPECT_NE(error.message.find("cannot be decoded: i"), std::string::npos)
            << error.message; // "it ...", "its ..."
    }
}

TEST(Images, APngOf16BitsKeepsThem)
{
    const std::vector<unsigned char> png = encodePng16(2, 1, {0x1234, 0xffff, 0xabcd, 0x8000});
    const TemporaryFolder folder;
    writeBytes(folder / "deep.png", png.data(), png.size());
    const auto images = decode(withTextureFile("deep.png"), folder);
    ASSERT_TRUE(images) << images.error().message;
    EXPECT_EQ((*images)[0].image.deep,
              (std::vector<uint16_t>{0x1234, 0x1234, 0x1234, 0xffff, 0xabcd, 0xabcd, 0xabcd, 0x8000}));
    EXPECT_EQ((*images)[0].image.texels, (std::vector<uint8_t>{18, 18, 18, 255, 171, 171, 171, 128})); // to nearest
}

TEST(Images, AKtx2TextureIsFoundByItsExtension)
{
    const std::vector<uint8_t> texels{1, 2, 3, 4, 5, 6, 7, 8};
    const std::vector<std::byte> ktx2 =
        makeKtx2({.vk_format = 43, .width = 2, .height = 1}, std::as_bytes(std::span(texels)));
    const TemporaryFolder folder;
    writeBytes(folder / "t.ktx2", ktx2.data(), ktx2.size());
    GltfBuilder builder = withTextureFile("t.ktx2");
    builder.json["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
    builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {"KHR_texture_basisu"};
    const auto images = decode(builder, folder);
    ASSERT_TRUE(images) << images.error().message;
    EXPECT_EQ((*images)[0].image.texels, texels);
}

TEST(Images, LightInAKtx2TextureOfFloatsIsEncodedWhereItIsColour)
{
    const std::vector<float> light{0.5f, 0.0f, 1.0f, 0.5f};
    const std::vector<std::byte> ktx2 =
        makeKtx2({.vk_format = 109, .width = 1, .height = 1}, std::as_bytes(std::span(light)));
    const TemporaryFolder folder;
    writeBytes(folder / "t.ktx2", ktx2.data(), ktx2.size());
    const auto images = decode(withTextureFile("t.ktx2"), folder);
    ASSERT_TRUE(images) << images.error().message;
    EXPECT_EQ((*images)[0].image.texels, (std::vector<uint8_t>{188, 0, 255, 128})); // sRGB of 0.5 is 0.7354
}

TEST(Images, Ktx2OfAnotherFormatIsUnsupportedAndNamed)
{
    const std::vector<std::byte> ktx2 =
        makeKtx2({.vk_format = 158, .width = 4, .height = 4}, std::vector<std::byte>(16));
    const TemporaryFolder folder;
    writeBytes(folder / "t.ktx2", ktx2.data(), ktx2.size());
    const Error error = failure("t.ktx2", folder);
    EXPECT_EQ(error.code, ExitCode::kUnsupported);
    EXPECT_NE(error.message.find("t.ktx2"), std::string::npos) << error.message;
    EXPECT_NE(error.message.find("VkFormat 158"), std::string::npos) << error.message;
}

TEST(Images, OtherFormatsAreUnsupportedAndNamed)
{
    using namespace std::string_literals;
    const std::pair<std::string, const char*> formats[] = {{"BM and more"s, "a BMP"},
                                                           {"GIF89a and more"s, "a GIF"},
                                                           {"DDS | and more"s, "a DDS"},
                                                           {"\0\0\0\x20"
                                                            "ftypavif"s,
                                                            "an AVIF"},
                                                           {"II*\0 and more"s, "a TIFF"}};
    for (const auto& [content, name] : formats)
    {
        const TemporaryFolder folder;
        writeBytes(folder / "t.png", content.data(), content.size());
        const Error error = failure("t.png", folder);
        EXPECT_EQ(error.code, ExitCode::kUnsupported);
        EXPECT_NE(error.message.find(name), std::string::npos) << error.message;
    }
}
} // namespace
