#include "compiler/gltf_accessor.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

namespace
{
/// Reads accessor 0 of what `builder` holds as floats.
Result<FloatArray> floats(const GltfBuilder& builder, uint32_t min_components = 1, uint32_t max_components = 4)
{
    const TemporaryFolder folder;
    const Result<GltfFile> file = builder.read(folder);
    if (!file)
        return file.error();
    return readFloats(file->model, 0, min_components, max_components);
}

TEST(Accessor, ConvertsEveryComponentType)
{
    struct Case
    {
        int component_type;
        bool normalized;
        std::vector<uint8_t> bytes;
        std::vector<float> want;
    };
    const std::vector<Case> cases{
        {5120, false, {0x80, 0x7f}, {-128, 127}},
        {5120, true, {0x80, 0x7f}, {-1, 1}}, // -128 / 127 is clamped
        {5121, false, {0, 255}, {0, 255}},
        {5121, true, {51, 255}, {0.2f, 1}},
        {5122, false, {0x00, 0x80, 0xff, 0x7f}, {-32768, 32767}},
        {5122, true, {0x01, 0x80, 0xff, 0x7f}, {-1, 1}},
        {5123, false, {0x34, 0x12, 0xff, 0xff}, {0x1234, 65535}},
        {5123, true, {0, 0, 0xff, 0xff}, {0, 1}},
        {5125, false, {1, 0, 0, 0, 0, 0, 1, 0}, {1, 65536}},
        {5126, false, {0, 0, 0x80, 0x3f, 0, 0, 0x20, 0xc1}, {1, -10}},
    };
    for (const Case& c : cases)
    {
        GltfBuilder builder;
        builder.accessor(c.bytes, "SCALAR", c.component_type, 2, c.normalized);
        const Result<FloatArray> got = floats(builder);
        ASSERT_TRUE(got) << got.error().message;
        EXPECT_EQ(got->values, c.want) << c.component_type << " normalized " << c.normalized;
    }
}

TEST(Accessor, ReadsInterleavedElements)
{
    const std::vector<float> data{1, 2, 3, 10, 20, 4, 5, 6, 40, 50};
    GltfBuilder builder;
    const int view = builder.view(data.data(), data.size() * 4, 20);
    builder.accessorOf(view, 12, "VEC2", 5126, 2);
    const Result<FloatArray> got = floats(builder);
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_EQ(got->values, (std::vector<float>{10, 20, 40, 50}));
}

TEST(Accessor, AppliesSparseValuesOverDataAndOverZeros)
{
    for (const bool with_data : {true, false})
    {
        GltfBuilder builder;
        builder.accessor(std::vector<float>{1, 2, 3}, "SCALAR", 5126, 3);
        const std::vector<uint8_t> indices{2};
        const std::vector<float> values{7};
        const int index_view = builder.view(indices.data(), 1);
        const int value_view = builder.view(values.data(), 4);
        builder.json["accessors"][0]["sparse"] = {{"count", 1},
                                                  {"indices", {{"bufferView", index_view}, {"componentType", 5121}}},
                                                  {"values", {{"bufferView", value_view}}}};
        if (!with_data)
            builder.json["accessors"][0].erase("bufferView");
        const Result<FloatArray> got = floats(builder);
        ASSERT_TRUE(got) << got.error().message;
        EXPECT_EQ(got->values, with_data ? (std::vector<float>{1, 2, 7}) : (std::vector<float>{0, 0, 7}));
    }
}

/// Makes elements of accessor `accessor` sparse ones.
template <typename T>
void replaceSparsely(GltfBuilder& builder, int accessor, const std::vector<uint16_t>& places,
                     const std::vector<T>& values)
{
    const int index_view = builder.view(places.data(), places.size() * sizeof(uint16_t));
    const int value_view = builder.view(values.data(), values.size() * sizeof(T));
    builder.json["accessors"][size_t(accessor)]["sparse"] = {
        {"count", places.size()},
        {"indices", {{"bufferView", index_view}, {"componentType", 5123}}},
        {"values", {{"bufferView", value_view}}}};
}

TEST(Accessor, SparseIndicesReplaceThoseOfTheirViewOrZeros)
{
    for (const bool with_data : {true, false})
    {
        GltfBuilder builder;
        const int indices = builder.accessor(std::vector<uint32_t>{0, 9, 9, 2, 9, 0}, "SCALAR", 5125, 6);
        replaceSparsely(builder, indices, {1, 2, 4}, std::vector<uint32_t>{1, 2, 3});
        if (!with_data)
        {
            replaceSparsely(builder, indices, {1, 2, 3, 4}, std::vector<uint32_t>{1, 2, 2, 3});
            builder.json["accessors"][size_t(indices)].erase("bufferView");
        }
        const int positions = builder.positions({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
        builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}})}});
        const auto imported = builder.import();
        ASSERT_TRUE(imported) << imported.error().message;
        const std::vector<gpu::uvec3>& triangles = imported->primitives[0].triangles;
        ASSERT_EQ(triangles.size(), 2u);
        EXPECT_TRUE(triangles[0].x == 0 && triangles[0].y == 1 && triangles[0].z == 2) << with_data;
        EXPECT_TRUE(triangles[1].x == 2 && triangles[1].y == 3 && triangles[1].z == 0) << with_data;
    }
}

TEST(Accessor, SparsePartsOfIndicesAreChecked)
{
    const auto code = [](const std::vector<uint16_t>& places, const char* key, const nlohmann::json& value)
    {
        GltfBuilder builder;
        const int indices = builder.accessor(std::vector<uint32_t>{0, 1, 2}, "SCALAR", 5125, 3);
        replaceSparsely(builder, indices, places, std::vector<uint32_t>(places.size(), 2));
        builder.triangle({{"indices", indices}});
        if (key != nullptr)
            builder.json["accessors"][0]["sparse"][key] = value;
        return strictCode(builder.import());
    };
    EXPECT_EQ(code({2}, nullptr, {}), ExitCode::kOk);
    EXPECT_EQ(code({3}, nullptr, {}), ExitCode::kInvalid);
    EXPECT_EQ(code({2}, "count", 4), ExitCode::kInvalid);
    EXPECT_EQ(code({2}, "count", -1), ExitCode::kInvalid);
    EXPECT_EQ(code({2}, "indices", {{"bufferView", 9}, {"componentType", 5123}}), ExitCode::kInvalid);
    EXPECT_EQ(code({2}, "indices", {{"bufferView", 1}, {"componentType", 5122}}), ExitCode::kInvalid);
    EXPECT_EQ(code({2}, "values", {{"bufferView", 2}, {"byteOffset", 1}}), ExitCode::kInvalid);
}

TEST(Accessor, WhatReachesOutsideIsReplacedWithAWarningOrRefused)
{
    const auto refused = [](const char* key, const nlohmann::json& value, const char* list = "accessors")
    {
        GltfBuilder builder;
        builder.accessor(std::vector<float>{1, 2, 3}, "SCALAR", 5126, 3);
        builder.json[list][0][key] = value;
        const TemporaryFolder folder;
        const Result<GltfFile> file = builder.read(folder);
        if (!file || !damageAmong(file->warnings).empty())
            return bool(file);
        const Result<FloatArray> got = readFloats(file->model, 0, 1, 4);
        return !got && got.error().code == ExitCode::kInvalid && !got.error().message.empty();
    };
    EXPECT_TRUE(refused("count", 4));
    EXPECT_TRUE(refused("count", 4000000000u));
    EXPECT_TRUE(refused("byteOffset", 4));
    EXPECT_TRUE(refused("byteOffset", 0xffffffffffffull));
    EXPECT_TRUE(refused("bufferView", 9));
    EXPECT_TRUE(refused("type", "VEC2"));
    EXPECT_TRUE(refused("byteLength", 8, "bufferViews"));
    EXPECT_TRUE(refused("byteLength", 4000, "bufferViews"));
    EXPECT_TRUE(refused("byteOffset", 4, "bufferViews"));
    EXPECT_TRUE(refused("buffer", 3, "bufferViews"));
}

TEST(Accessor, TrianglesWhoseIndicesNameNoVertexAreLeftOut)
{
    GltfBuilder builder;
    const int indices = builder.accessor(std::vector<uint16_t>{0, 1, 3, 0, 1, 2}, "SCALAR", 5123, 6);
    builder.triangle({{"indices", indices}});
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->mesh.triangles.size(), 1u);
    ASSERT_EQ(scene->warnings.size(), 1u);
    EXPECT_EQ(scene->warnings[0].message, "1 of 2 triangles name vertices beyond the 3 that there are");
}
} // namespace
