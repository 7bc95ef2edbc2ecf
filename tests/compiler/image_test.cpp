#include "compiler/images.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

namespace
{
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
                                            webp, text, "\xFF\xD8\xFF", ""};
    for (const std::string& content : contents)
    {
        const TemporaryFolder folder;
        writeBytes(folder / "bad.png", content.data(), content.size());
        const Error error = failure("bad.png", folder);
        EXPECT_EQ(error.code, ExitCode::kInvalid);
        EXPECT_NE(error.message.find("bad.png"), std::string::npos) << error.message;
        EXPECT_NE(error.message.find("cannot be decoded: i"), std::string::npos) << error.message; // "it ...", "its ..."
    }
}

TEST(Images, OtherFormatsAreUnsupportedAndNamed)
{
    using namespace std::string_literals;
    const std::pair<std::string, const char*> formats[] = {
        {"\xABKTX 20\xBB\r\n\x1A\n and more"s, "a KTX2"}, {"BM and more"s, "a BMP"},
        {"GIF89a and more"s, "a GIF"},                      {"DDS | and more"s, "a DDS"},
        {"\0\0\0\x20" "ftypavif"s, "an AVIF"},              {"II*\0 and more"s, "a TIFF"}};
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
