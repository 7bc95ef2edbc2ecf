#include "compiler/encode.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

namespace
{
/// The triangle (0,0,0) (1,0,0) (0,1,0) with two targets: up by 1 along z; the corners apart along x.
GltfBuilder morphed()
{
    GltfBuilder builder;
    builder.triangle();
    const int up = builder.positions({0, 0, 1, 0, 0, 1, 0, 0, 1});
    const int apart = builder.positions({-1, 0, 0, 1, 0, 0, 0, 0, 0});
    builder.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", up}}, {{"POSITION", apart}}};
    return builder;
}

nlohmann::json& primitive(GltfBuilder& builder)
{
    return builder.json["meshes"][0]["primitives"][0];
}

std::vector<gpu::vec3> positions(const GltfBuilder& builder, const char* what)
{
    const Result<SceneData> scene = builder.scene();
    EXPECT_TRUE(scene) << what << ": " << scene.error().message;
    return scene ? scene->mesh.positions : std::vector<gpu::vec3>(3);
}

TEST(Morph, WeightsAreTheNodesElseTheMeshsElseZero)
{
    GltfBuilder builder = morphed();
    EXPECT_EQ(positions(builder, "none")[1].z, 0);
    builder.json["meshes"][0]["weights"] = {0.5, 0};
    EXPECT_EQ(positions(builder, "mesh")[1].z, 0.5f);
    builder.json["nodes"][0]["weights"] = {2, 1};
    const std::vector<gpu::vec3> p = positions(builder, "node");
    EXPECT_EQ(p[0].x, -1);
    EXPECT_EQ(p[1].x, 2);
    EXPECT_EQ(p[2].z, 2);
    builder.json["nodes"][0]["weights"] = {0, 0};
    EXPECT_EQ(positions(builder, "node, zeros")[1].z, 0);
    builder.json["nodes"][0]["weights"] = {3}; // missing ones are 0, spare ones count nothing
    EXPECT_EQ(positions(builder, "short")[1].z, 3);
    builder.json["nodes"][0]["weights"] = {3, 0, 9};
    EXPECT_EQ(positions(builder, "long")[1].z, 3);
}

TEST(Morph, EachNodeHasItsOwnShape)
{
    GltfBuilder builder = morphed();
    builder.node({{"mesh", 0}, {"weights", {1, 0}}, {"translation", {5, 0, 0}}});
    builder.node({{"mesh", 0}, {"weights", {1, 0}}, {"translation", {9, 0, 0}}});
    builder.json["scenes"][0]["nodes"] = {0, 1, 2};
    const auto imported = builder.import();
    ASSERT_TRUE(imported) << imported.error().message;
    EXPECT_EQ(imported->primitives.size(), 2u); // equal shapes are kept once
    const std::vector<gpu::vec3> p = positions(builder, "three nodes");
    ASSERT_EQ(p.size(), 9u);
    EXPECT_EQ(p[0].z, 0);
    EXPECT_EQ(p[3].z, 1);
    EXPECT_EQ(p[3].x, 5);
    EXPECT_EQ(p[6].x, 9);
}

TEST(Morph, SparseAndQuantizedTargetsAreRead)
{
    GltfBuilder builder = morphed();
    builder.json["nodes"][0]["weights"] = {1, 1};
    nlohmann::json& targets = primitive(builder)["targets"];
    const std::vector<uint16_t> places{2};
    const std::vector<float> moves{0, 0, 4};
    const int sparse = builder.positions({0, 0, 0, 0, 0, 0, 0, 0, 0});
    nlohmann::json& accessor = builder.json["accessors"][size_t(sparse)];
    accessor.erase("bufferView");
    const int place_view = builder.view(places.data(), 2);
    const int move_view = builder.view(moves.data(), 12);
    accessor["sparse"] = {{"count", 1},
                          {"indices", {{"bufferView", place_view}, {"componentType", 5123}}},
                          {"values", {{"bufferView", move_view}}}};
    targets[0]["POSITION"] = sparse;
    const std::vector<int16_t> quantized{0, 32767, 0, 0, 0, -32767, 0, 0, 0, 0, 0, 0}; // 8 bytes a vertex
    targets[1]["POSITION"] = builder.accessorOf(builder.view(quantized.data(), 24, 8), 0, "VEC3", 5122, 3, true);
    const std::vector<gpu::vec3> p = positions(builder, "sparse and quantized");
    EXPECT_EQ(p[0].y, 1);
    EXPECT_EQ(p[1].y, -1);
    EXPECT_EQ(p[2].z, 4);
}

TEST(Morph, NormalsTangentsCoordinatesAndColoursMoveToo)
{
    GltfBuilder builder = morphed();
    const std::vector<float> along_z{0, 0, 1, 0, 0, 1, 0, 0, 1};
    const std::vector<float> along_x{1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1};
    const std::vector<float> turn_normal{1, 0, -1, 1, 0, -1, 1, 0, -1};  // to +x
    const std::vector<float> turn_tangent{-1, 1, 0, -1, 1, 0, -1, 1, 0}; // to +y; the sign stays
    nlohmann::json& p = primitive(builder);
    p["attributes"]["NORMAL"] = builder.accessor(along_z, "VEC3", 5126, 3);
    p["attributes"]["TANGENT"] = builder.accessor(along_x, "VEC4", 5126, 3);
    p["attributes"]["TEXCOORD_0"] = builder.accessor(std::vector<float>(6), "VEC2", 5126, 3);
    p["attributes"]["COLOR_0"] = builder.accessor(std::vector<float>(9, 0.5f), "VEC3", 5126, 3);
    p["targets"] = {{{"NORMAL", builder.accessor(turn_normal, "VEC3", 5126, 3)},
                     {"TANGENT", builder.accessor(turn_tangent, "VEC3", 5126, 3)},
                     {"TEXCOORD_0", builder.accessor(std::vector<float>(6, 0.25f), "VEC2", 5126, 3)},
                     {"COLOR_0", builder.accessor(std::vector<float>(9, -0.25f), "VEC3", 5126, 3)}}};
    builder.json["nodes"][0]["weights"] = {1};
    const auto imported = builder.import();
    ASSERT_TRUE(imported) << imported.error().message;
    const MeshPrimitive& mesh = imported->primitives[0];
    EXPECT_EQ(mesh.normals[1].x, 1);
    EXPECT_EQ(mesh.normals[1].z, 0);
    EXPECT_EQ(mesh.tangents[2].x, 0);
    EXPECT_EQ(mesh.tangents[2].y, 1);
    EXPECT_EQ(mesh.tangents[2].w, -1);
    EXPECT_EQ(mesh.uv0[0].y, 0.25f);
    EXPECT_EQ(mesh.colors[0].x, 0.25f);
    EXPECT_EQ(mesh.colors[0].w, 1);
}

TEST(Morph, MadeNormalsAreThoseOfTheShape)
{
    GltfBuilder builder = morphed();
    primitive(builder)["targets"] = {
        {{"POSITION", builder.positions({0, 0, 0, 0, 0, 0, 0, -1, 1})}}}; // (0,1,0) to (0,0,1)
    builder.json["nodes"][0]["weights"] = {1};
    const auto imported = builder.import();
    ASSERT_TRUE(imported) << imported.error().message;
    EXPECT_NEAR(imported->primitives[0].normals[0].y, -1, 1e-6);
}

TEST(Morph, JointsPlaceTheMorphedShape)
{
    GltfBuilder builder = morphed();
    builder.json["nodes"][0]["weights"] = {1, 0};
    primitive(builder)["attributes"]["JOINTS_0"] = builder.accessor(std::vector<uint8_t>(12), "VEC4", 5121, 3);
    primitive(builder)["attributes"]["WEIGHTS_0"] =
        builder.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 5126, 3);
    builder.json["skins"] = {{{"joints", {builder.node({{"scale", {3, 3, 3}}})}}}};
    builder.json["nodes"][0]["skin"] = 0;
    EXPECT_EQ(positions(builder, "skinned")[1].x, 3);
    EXPECT_EQ(positions(builder, "skinned")[1].z, 3);
}

TEST(Morph, DamagedTargetsAreReportedWhereTheyCount)
{
    const auto code = [](const nlohmann::json& target, double weight)
    {
        GltfBuilder builder = morphed();
        builder.positions({0, 0, 1}); // accessor 3, too short
        builder.accessor(std::vector<float>{3e38f, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3", 5126, 3);
        primitive(builder)["targets"][0] = target;
        builder.json["nodes"][0]["weights"] = {weight};
        const auto imported = builder.import();
        EXPECT_TRUE(imported && imported->primitives.size() == 1); // it is drawn all the same
        return strictCode(imported);
    };
    EXPECT_EQ(code({{"POSITION", 1}}, 1), ExitCode::kOk);
    EXPECT_EQ(code({{"POSITION", 3}}, 1), ExitCode::kInvalid);
    EXPECT_EQ(code({{"POSITION", 99}}, 1), ExitCode::kInvalid);
    EXPECT_EQ(code({{"POSITION", -1}}, 1), ExitCode::kInvalid);
    EXPECT_EQ(code({{"POSITION", 4}}, 2), ExitCode::kInvalid); // beyond floats
    EXPECT_EQ(code({{"POSITION", 3}}, 0), ExitCode::kOk);
}
} // namespace
