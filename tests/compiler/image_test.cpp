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

Result<std::vector<TextureImage>> decode(const GltfBuilder& builder, const TemporaryFolder& folder)
{
    const Result<GltfFile> file = builder.read(folder);
    if (!file)
        return file.error();
    const Result<ImportedScene> imported = importScene(*file);
    if (!imported)
        return imported.error();
    return decodeImages(*file, imported->images);
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
    EXPECT_EQ((*images)[0].width, 2u);
    EXPECT_EQ((*images)[0].texels, texels);
    EXPECT_TRUE((*images)[0].srgb);
}

TEST(Images, AMissingFileIsAnInputErrorThatNamesIt)
{
    const TemporaryFolder folder;
    const auto images = decode(withTextureFile("gone.png"), folder);
    ASSERT_FALSE(images);
    EXPECT_EQ(images.error().code, ExitCode::kIo);
    EXPECT_NE(images.error().message.find("gone.png"), std::string::npos) << images.error().message;
}

TEST(Images, DamagedOnesAreInvalidAndNamed)
{
    const std::vector<unsigned char> png = encodePng(2, 1, {255, 0, 0, 255, 0, 128, 0, 64});
    const std::string webp("RIFF\x10\0\0\0WEBPVP8 nonsense", 24);
    const std::string text = "no picture";
    const std::vector<std::string> contents{std::string(png.begin(), png.begin() + 40), webp, text, ""};
    for (const std::string& content : contents)
    {
        const TemporaryFolder folder;
        writeBytes(folder / "bad.png", content.data(), content.size());
        const auto images = decode(withTextureFile("bad.png"), folder);
        ASSERT_FALSE(images);
        EXPECT_EQ(images.error().code, ExitCode::kInvalid);
        EXPECT_NE(images.error().message.find("bad.png"), std::string::npos) << images.error().message;
    }
}

TEST(Images, Ktx2IsUnsupported)
{
    const std::string ktx2("\xABKTX 20\xBB\r\n\x1A\n and more", 20);
    const TemporaryFolder folder;
    writeBytes(folder / "t.ktx2", ktx2.data(), ktx2.size());
    const auto images = decode(withTextureFile("t.ktx2"), folder);
    ASSERT_FALSE(images);
    EXPECT_EQ(images.error().code, ExitCode::kUnsupported);
}
} // namespace
