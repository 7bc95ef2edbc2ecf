#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

namespace
{
Result<ImportedScene> withExtensions(const std::vector<std::string>& used, const std::vector<std::string>& required)
{
    GltfBuilder builder;
    builder.triangle();
    builder.json["extensionsUsed"] = used;
    if (!required.empty())
        builder.json["extensionsRequired"] = required;
    return builder.import();
}

TEST(Extensions, AnUnknownRequiredOneIsUnsupportedAndNamed)
{
    for (const char* name : {"ACME_future", "ACME_other"})
    {
        const auto imported = withExtensions({name}, {name});
        ASSERT_FALSE(imported) << name;
        EXPECT_EQ(imported.error().code, ExitCode::kUnsupported);
        EXPECT_NE(imported.error().message.find(name), std::string::npos) << imported.error().message;
    }
}

TEST(Extensions, UnknownUsedOnesAreListedInOneWarning)
{
    const auto imported = withExtensions({"ACME_other", "KHR_texture_transform", "ACME_future"}, {});
    ASSERT_TRUE(imported) << imported.error().message;
    ASSERT_EQ(imported->scene.warnings.size(), 1u);
    const std::string warning = sentence(imported->scene.warnings[0]);
    EXPECT_NE(warning.find("ACME_other"), std::string::npos) << warning;
    EXPECT_NE(warning.find("ACME_future"), std::string::npos) << warning;
    EXPECT_EQ(warning.find("KHR_texture_transform"), std::string::npos) << warning;
}

TEST(Extensions, HonouredOnesAreNoWarning)
{
    const auto imported = withExtensions({"KHR_materials_ior", "KHR_materials_variants"}, {"KHR_materials_variants"});
    ASSERT_TRUE(imported) << imported.error().message;
    EXPECT_TRUE(imported->scene.warnings.empty());
}

TEST(Extensions, AnotherGltfVersionIsUnsupported)
{
    for (const char* version : {"1.0", "3.0"})
    {
        GltfBuilder builder;
        builder.triangle();
        builder.json["asset"]["version"] = version;
        const auto imported = builder.import();
        ASSERT_FALSE(imported) << version;
        EXPECT_EQ(imported.error().code, ExitCode::kUnsupported);
    }
}

TEST(Extensions, DeeplyNestedExtensionsAreRefusedInsteadOfOverflowingTheStack)
{
    GltfBuilder builder;
    builder.triangle();
    std::string text = builder.text();
    const std::string deep = "\"extras\":" + std::string(200000, '[') + std::string(200000, ']') + ",";
    text.insert(1, deep);
    const TemporaryFolder folder;
    writeBytes(folder / "deep.gltf", text.data(), text.size());
    const Result<GltfFile> file = readGltf(folder / "deep.gltf");
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().code, ExitCode::kInvalid);
}
} // namespace
