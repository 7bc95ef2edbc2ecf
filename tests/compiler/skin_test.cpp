#include "compiler/encode.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
const std::vector<float> kQuad{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};

std::vector<float> translation(float x, float y, float z)
{
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1};
}

using Joints = std::vector<nlohmann::json>;

nlohmann::json still()
{
    return nlohmann::json::object();
}

nlohmann::json moved(float x, float y, float z)
{
    return {{"translation", {x, y, z}}};
}

nlohmann::json scaled(float x, float y, float z)
{
    return {{"scale", {x, y, z}}};
}

/// A square of four vertices that follows joints; node 0 shows it, the nodes after it are the joints.
class SkinnedSquare
{
public:
    GltfBuilder builder;

    /// @param weights four a vertex, of joints 0 to 3
    explicit SkinnedSquare(const Joints& joints, const std::vector<float>& weights = {},
                           const std::vector<float>& positions = kQuad)
    {
        const std::vector<float> first{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
        std::vector<uint8_t> numbers;
        for (size_t v = 0; v < 4; ++v)
            for (uint8_t k = 0; k < 4; ++k)
                numbers.push_back(k < joints.size() ? k : 0);
        const int indices = builder.accessor(std::vector<uint8_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5121, 6);
        const nlohmann::json attributes = {
            {"POSITION", builder.positions(positions)},
            {"JOINTS_0", builder.accessor(numbers, "VEC4", 5121, 4)},
            {"WEIGHTS_0", builder.accessor(weights.empty() ? first : weights, "VEC4", 5126, 4)}};
        builder.node({{"mesh", builder.mesh({{"attributes", attributes}, {"indices", indices}})}, {"skin", 0}});
        nlohmann::json& skin = builder.json["skins"][0];
        for (const nlohmann::json& joint : joints)
        {
            skin["joints"].push_back(builder.node(joint));
            builder.json["scenes"][0]["nodes"].push_back(skin["joints"].back());
        }
    }

    nlohmann::json& attributes() { return builder.json["meshes"][0]["primitives"][0]["attributes"]; }
    nlohmann::json& skin() { return builder.json["skins"][0]; }

    void inverseBind(const std::vector<float>& matrices)
    {
        skin()["inverseBindMatrices"] = builder.accessor(matrices, "MAT4", 5126, matrices.size() / 16);
    }
};

/// Corners of the square as they are seen, whichever order its vertices have.
void expectCorners(const GltfBuilder& builder, const std::vector<gpu::vec3>& want, const char* what)
{
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << what << ": " << scene.error().message;
    ASSERT_EQ(scene->mesh.positions.size(), want.size()) << what;
    for (size_t v = 0; v < want.size(); ++v)
    {
        EXPECT_NEAR(scene->mesh.positions[v].x, want[v].x, 1e-5) << what << ", vertex " << v;
        EXPECT_NEAR(scene->mesh.positions[v].y, want[v].y, 1e-5) << what << ", vertex " << v;
        EXPECT_NEAR(scene->mesh.positions[v].z, want[v].z, 1e-5) << what << ", vertex " << v;
    }
}

const std::vector<gpu::vec3> kSquare{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};

TEST(Skin, JointsPlaceTheMeshAndItsNodeDoesNot)
{
    SkinnedSquare displaced(Joints{still()});
    displaced.builder.json["nodes"][0]["translation"] = {3, 0, 0};
    displaced.builder.json["nodes"][0]["scale"] = {0.25, 0.25, 0.25};
    expectCorners(displaced.builder, kSquare, "node moved");

    std::vector<float> centimetres = kQuad;
    for (float& v : centimetres)
        v *= 100;
    const SkinnedSquare small(Joints{scaled(0.01f, 0.01f, 0.01f)}, {}, centimetres);
    expectCorners(small.builder, kSquare, "scaled joint");

    SkinnedSquare parent(Joints{still()}, {}, centimetres); // one parent of joint and mesh: counts once
    const int armature = parent.builder.node({{"children", {0, 1}}, {"scale", {0.01, 0.01, 0.01}}});
    parent.builder.json["scenes"][0]["nodes"] = {armature};
    expectCorners(parent.builder, kSquare, "armature");

    const float h = std::sqrt(0.5f);
    const nlohmann::json quarter_turn = {{"rotation", {h, 0, 0, h}}};
    const SkinnedSquare standing(Joints{quarter_turn}, {}, {-1, 0, 1, 1, 0, 1, 1, 0, -1, -1, 0, -1});
    expectCorners(standing.builder, kSquare, "turned joint");

    SkinnedSquare bound(Joints{moved(0, 5, 0)});
    bound.inverseBind(translation(0, -5, 0));
    expectCorners(bound.builder, kSquare, "bind matrix undone");
    bound.builder.json["nodes"][1]["translation"] = {2, 5, 0}; // two metres from where it was bound
    expectCorners(bound.builder, {{1, -1, 0}, {3, -1, 0}, {3, 1, 0}, {1, 1, 0}}, "joint moved");
}

TEST(Skin, JointsOutsideTheSceneAndInHiddenNodesPlaceItToo)
{
    SkinnedSquare outside(Joints{moved(0, 0, 2)});
    outside.builder.node({{"children", {1}}, {"translation", {0, 0, 1}}});
    outside.builder.json["scenes"][0]["nodes"] = {0};
    const std::vector<gpu::vec3> want{{-1, -1, 3}, {1, -1, 3}, {1, 1, 3}, {-1, 1, 3}};
    expectCorners(outside.builder, want, "outside");
    outside.builder.json["nodes"][2]["extensions"]["KHR_node_visibility"]["visible"] = false;
    outside.builder.json["scenes"][0]["nodes"] = {0, 2};
    expectCorners(outside.builder, want, "hidden");
}

TEST(Skin, WeightsOfAllSetsBlendAndAreNormalized)
{
    // Joint 0 stays, joint 1 moves by 8 along x; vertices follow joint 1 by 0, 1/4, 1/2 and 1/8.
    const Joints joints{still(), moved(8, 0, 0)};
    const std::vector<gpu::vec3> want{{-1, -1, 0}, {3, -1, 0}, {5, 1, 0}, {0, 1, 0}};
    const std::vector<float> exact{1, 0, 0, 0, 0.75f, 0.25f, 0, 0, 0.5f, 0.5f, 0, 0, 0.875f, 0.125f, 0, 0};
    expectCorners(SkinnedSquare(joints, exact).builder, want, "exact");
    std::vector<float> doubled = exact;
    for (float& w : doubled)
        w *= 2;
    expectCorners(SkinnedSquare(joints, doubled).builder, want, "doubled");

    SkinnedSquare bytes(joints);
    const std::vector<uint8_t> normalized{255, 0, 0, 0, 153, 51, 0, 0, 127, 127, 0, 0, 210, 30, 0, 0};
    bytes.attributes()["WEIGHTS_0"] = bytes.builder.accessor(normalized, "VEC4", 5121, 4, true);
    expectCorners(bytes.builder, want, "normalized bytes");

    SkinnedSquare sets(joints, {1, 0, 0, 0, 0.5f, 0, 0, 0, 0.25f, 0.25f, 0, 0, 0, 0, 0, 0});
    const std::vector<uint16_t> second{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
    sets.attributes()["JOINTS_1"] = sets.builder.accessor(second, "VEC4", 5123, 4);
    sets.attributes()["WEIGHTS_1"] = sets.builder.accessor(
        std::vector<float>{0, 0, 0, 0, 0.25f, 0.25f, 0, 0, 0.25f, 0.25f, 0, 0, 0.875f, 0.125f, 0, 0}, "VEC4", 5126, 4);
    expectCorners(sets.builder, want, "two sets");
}

TEST(Skin, VerticesWithoutWeightsFollowTheirFirstJointAndAreCounted)
{
    const SkinnedSquare square(Joints{moved(0, 0, 4), still()}, {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
    expectCorners(square.builder, {{-1, -1, 4}, {1, -1, 4}, {1, 1, 4}, {-1, 1, 4}}, "weightless");
    const auto imported = square.builder.import();
    ASSERT_EQ(imported->scene.warnings.size(), 1u);
    EXPECT_TRUE(imported->scene.warnings[0].message.starts_with("2 vertices")) << imported->scene.warnings[0].message;
}

TEST(Skin, NormalsFollowTheInverseTransposeAndMirroringJointsKeepThemOutside)
{
    const float h = std::sqrt(0.5f);
    SkinnedSquare square(Joints{scaled(2, 1, -1)});
    const std::vector<float> normals{h, 0, h, h, 0, h, h, 0, h, h, 0, h};
    const std::vector<float> tangents{0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1};
    square.attributes()["NORMAL"] = square.builder.accessor(normals, "VEC3", 5126, 4);
    square.attributes()["TANGENT"] = square.builder.accessor(tangents, "VEC4", 5126, 4);
    const Result<SceneData> scene = square.builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_TRUE(scene->warnings.empty()) << scene->warnings[0].message; // no triangle had to be flipped
    const gpu::vec3 want = normalizeOr({0.5f, 0, -1}, {});
    for (const gpu::VertexAttributes& vertex : scene->mesh.attributes)
    {
        const gpu::vec3 n = decodeNormal(vertex.normal);
        EXPECT_NEAR(n.x, want.x, 1e-4);
        EXPECT_NEAR(n.y, want.y, 1e-4);
        EXPECT_NEAR(n.z, want.z, 1e-4);
        EXPECT_NE(vertex.tangent & (1u << 16), 0u); // w was 1
    }
    const gpu::uvec3 t = scene->mesh.triangles[0];
    const auto& p = scene->mesh.positions;
    EXPECT_LT(cross(p[t.y] - p[t.x], p[t.z] - p[t.x]).z, 0);
}

TEST(Skin, EachNodeShowsTheMeshWhereItsOwnSkinPlacesIt)
{
    SkinnedSquare square(Joints{still()});
    const int joint = square.builder.node({{"translation", {0, 0, 7}}});
    square.builder.json["skins"].push_back({{"joints", {joint}}});
    const int second = square.builder.node({{"mesh", 0}, {"skin", 1}});
    const int plain =
        square.builder.node({{"mesh", 0}, {"translation", {9, 0, 0}}}); // without a skin its node places it
    square.builder.json["scenes"][0]["nodes"] = {0, second, plain};
    const Result<SceneData> scene = square.builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->mesh.positions.size(), 12u);
    EXPECT_EQ(scene->mesh.object_count, 3u);
    EXPECT_EQ(scene->mesh.positions[0].z, 0);
    EXPECT_EQ(scene->mesh.positions[4].z, 7);
    EXPECT_EQ(scene->mesh.positions[8].x, 8);
}

TEST(Skin, FarJointsKeepThePrecisionOfTheMesh)
{
    // World positions in single precision would be a metre apart at 10,000 km; in double precision they are 2e-9 m.
    const std::vector<float> small{0, 0, 0, 0.001f, 0, 0, 0.001f, 0.001f, 0, 0, 0.001f, 0};
    const SkinnedSquare square(Joints{moved(1e7, 0, 0)}, {}, small);
    const auto imported = square.builder.import();
    ASSERT_TRUE(imported) << imported.error().message;
    EXPECT_EQ(imported->instances[0].to_world.translation[0], 1e7);
    EXPECT_NEAR(imported->primitives[0].positions[2].x, 0.001f, 2e-9);
}

TEST(Skin, PrimitivesWithoutJointsStandWhereTheirNodeDoes)
{
    SkinnedSquare square(Joints{moved(0, 0, 4)});
    square.builder.json["nodes"][0]["translation"] = {0, 0, 1};
    square.attributes().erase("JOINTS_0");
    square.attributes().erase("WEIGHTS_0");
    expectCorners(square.builder, {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}, "no joints");
    EXPECT_EQ(square.builder.import()->scene.warnings.size(), 1u);
}

TEST(Skin, DamagedSkinsAreReported)
{
    const auto code = [](const auto& damage)
    {
        SkinnedSquare square(Joints{still(), still()});
        std::vector<float> two = translation(0, 0, 0);
        for (const float element : translation(0, 0, 0))
            two.push_back(element);
        square.inverseBind(two);
        damage(square);
        const auto imported = square.builder.import();
        EXPECT_TRUE(imported);
        return strictCode(imported);
    };
    EXPECT_EQ(code([](SkinnedSquare&) {}), ExitCode::kOk);
    EXPECT_EQ(code([](SkinnedSquare& s) { s.builder.json["nodes"][0]["skin"] = 4; }), ExitCode::kInvalid);
    EXPECT_EQ(code([](SkinnedSquare& s) { s.builder.json["nodes"][0]["skin"] = -2; }), ExitCode::kInvalid);
    EXPECT_EQ(code([](SkinnedSquare& s) { s.skin().erase("joints"); }), ExitCode::kInvalid);
    EXPECT_EQ(code([](SkinnedSquare& s) { s.skin()["joints"] = {1, 99}; }), ExitCode::kInvalid);
    EXPECT_EQ(code([](SkinnedSquare& s) { s.skin()["joints"] = {1, "2"}; }), ExitCode::kInvalid);
    EXPECT_EQ(code([](SkinnedSquare& s) { s.skin()["inverseBindMatrices"] = 99; }), ExitCode::kInvalid);
    EXPECT_EQ(code([](SkinnedSquare& s) { s.inverseBind(translation(0, 0, 0)); }), ExitCode::kInvalid); // one for two
    EXPECT_EQ(code([](SkinnedSquare& s) { s.attributes().erase("WEIGHTS_0"); }), ExitCode::kInvalid);
    EXPECT_EQ(code([](SkinnedSquare& s) { s.attributes()["JOINTS_0"] = s.attributes()["POSITION"]; }),
              ExitCode::kInvalid);
    EXPECT_EQ(code([](SkinnedSquare& s) { s.skin()["joints"] = {1}; }), ExitCode::kOk); // joint 1 has no weight
    EXPECT_EQ(code([](SkinnedSquare& s)
                   { s.attributes()["JOINTS_0"] = s.builder.accessor(std::vector<uint8_t>(16, 2), "VEC4", 5121, 4); }),
              ExitCode::kInvalid);
    EXPECT_EQ(code([](SkinnedSquare& s) { s.builder.json["nodes"][1]["children"] = {1}; }), ExitCode::kInvalid);
    EXPECT_EQ(code([](SkinnedSquare& s) { s.builder.json["nodes"][1]["scale"] = {1e300, 1, 1}; }), ExitCode::kInvalid);
}
} // namespace
