// Normals that point against their triangles: the winding defines the front, and the normals are flipped.
#include "compiler/build_lights.h"
#include "compiler/encode.h"
#include "compiler/linear.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

namespace
{
/// A quad in the xy plane, wound to face +z, u to the right and v down, under a normal map.
struct Quad
{
    float normal_z = 1;
    float tangent_sign = 0; // 0: the file has no tangents
    bool mirrored_uv = false;
    bool mirrored_node = false;
    bool emits = false;
};

GltfBuilder build(const Quad& quad)
{
    GltfBuilder builder;
    const int texture = builder.texture(1, 1, {128, 128, 255, 255});
    builder.material({{"normalTexture", {{"index", texture}}}});
    if (quad.emits)
        builder.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
    const float left = quad.mirrored_uv ? 1 : 0, right = 1 - left;
    const float n = quad.normal_z;
    nlohmann::json attributes = {
        {"POSITION", builder.positions({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})},
        {"NORMAL", builder.positions({0, 0, n, 0, 0, n, 0, 0, n, 0, 0, n})},
        {"TEXCOORD_0", builder.accessor(std::vector<float>{left, 1, right, 1, right, 0, left, 0}, "VEC2", 5126, 4)}};
    if (quad.tangent_sign != 0)
    {
        std::vector<float> tangents;
        for (int i = 0; i < 4; ++i)
            tangents.insert(tangents.end(), {right - left, 0, 0, quad.tangent_sign});
        attributes["TANGENT"] = builder.accessor(tangents, "VEC4", 5126, 4);
    }
    const int indices = builder.accessor(std::vector<uint8_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5121, 6);
    builder.node({{"mesh", builder.mesh({{"attributes", attributes}, {"indices", indices}, {"material", 0}})},
                  {"scale", {quad.mirrored_node ? -1 : 1, 1, 1}}});
    return builder;
}

gpu::vec3 facing(const WorldMesh& mesh, gpu::uvec3 t)
{
    return normalizeOr(cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]), {});
}

std::vector<std::string> flips(const SceneData& scene)
{
    std::vector<std::string> found;
    for (const std::string& warning : sentences(scene.warnings))
        if (warning.find("against their winding") != std::string::npos)
            found.push_back(warning);
    return found;
}

TEST(Winding, OpposingNormalsAreFlippedCountedAndReportedOnce)
{
    const Result<SceneData> scene = build({.normal_z = -1}).scene();
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->mesh.positions.size(), 4u);
    for (const gpu::VertexAttributes& v : scene->mesh.attributes)
        EXPECT_NEAR(decodeNormal(v.normal).z, 1, 1e-6);
    for (const gpu::uvec3 t : scene->mesh.triangles)
        EXPECT_EQ(facing(scene->mesh, t).z, 1); // the winding is the file's
    EXPECT_EQ(flips(*scene),
              std::vector<std::string>{"2 of 2 triangles have normals against their winding; they were flipped"});
    const Result<SceneData> plain = build({}).scene();
    ASSERT_TRUE(plain) << plain.error().message;
    EXPECT_TRUE(flips(*plain).empty());
}

/// Whatever the file's normals and tangent signs are: the frame is that of the quad whose normals agree.
TEST(Winding, FlippedNormalsKeepTheNormalMapsFrame)
{
    for (const bool mirrored_uv : {false, true})
        for (const bool mirrored_node : {false, true})
        {
            const Result<SceneData> plain = build({.mirrored_uv = mirrored_uv, .mirrored_node = mirrored_node}).scene();
            ASSERT_TRUE(plain) << plain.error().message;
            ASSERT_EQ(plain->mesh.attributes[0].tangent >> 16 & 1u, mirrored_uv != mirrored_node ? 1u : 0u);
            for (const float sign : {0.0f, 1.0f, -1.0f})
            {
                const Result<SceneData> flipped = build({.normal_z = -1,
                                                         .tangent_sign = sign,
                                                         .mirrored_uv = mirrored_uv,
                                                         .mirrored_node = mirrored_node})
                                                      .scene();
                ASSERT_TRUE(flipped) << flipped.error().message;
                ASSERT_EQ(flipped->mesh.attributes.size(), plain->mesh.attributes.size());
                for (size_t i = 0; i < plain->mesh.attributes.size(); ++i)
                {
                    const gpu::VertexAttributes& a = plain->mesh.attributes[i];
                    const gpu::VertexAttributes& b = flipped->mesh.attributes[i];
                    EXPECT_EQ(a.normal, b.normal) << i << " sign " << sign;
                    EXPECT_EQ(a.tangent, b.tangent) << i << " sign " << sign;
                }
            }
        }
}

TEST(Winding, MirroredNodesFlipNothing)
{
    const Result<SceneData> scene = build({.mirrored_node = true}).scene();
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_TRUE(flips(*scene).empty());
    for (const gpu::uvec3 t : scene->mesh.triangles)
        EXPECT_GT(dot(facing(scene->mesh, t), decodeNormal(scene->mesh.attributes[t.x].normal)), 0.99f);
}

TEST(Winding, AVertexThatOtherTrianglesAgreeWithIsSplit)
{
    GltfBuilder builder; // front and back of one quad over the same four vertices, normals to the front
    const int positions = builder.positions({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    const int normals = builder.positions({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    const std::vector<uint8_t> indices{0, 1, 2, 0, 2, 1, 0, 2, 3, 0, 3, 2};
    const int accessor = builder.accessor(indices, "SCALAR", 5121, indices.size());
    builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
                                         {"indices", accessor}})}});
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->mesh.triangles.size(), 4u);
    EXPECT_EQ(scene->mesh.positions.size(), 8u);
    EXPECT_EQ(scene->mesh.attributes.size(), 8u);
    for (const gpu::uvec3 t : scene->mesh.triangles)
        for (const uint32_t v : {t.x, t.y, t.z})
            EXPECT_NEAR(decodeNormal(scene->mesh.attributes[v].normal).z, facing(scene->mesh, t).z, 1e-6);
    EXPECT_EQ(flips(*scene),
              std::vector<std::string>{"2 of 4 triangles have normals against their winding; they were flipped"});
}

TEST(Winding, TrianglesWithMixedOrGrazingNormalsStayAsTheyAre)
{
    for (const std::array<float, 9>& normals : {std::array<float, 9>{0, 0, 1, 0, 0, -1, 0, 0, -1},
                                                std::array<float, 9>{1, 0, -0.01f, 1, 0, -0.01f, 1, 0, -0.01f}})
    {
        GltfBuilder builder;
        const int accessor = builder.positions({normals.begin(), normals.end()});
        builder.triangle({{"attributes", {{"NORMAL", accessor}}}});
        const Result<SceneData> scene = builder.scene();
        ASSERT_TRUE(scene) << scene.error().message;
        EXPECT_TRUE(flips(*scene).empty());
        for (size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(decodeNormal(scene->mesh.attributes[i].normal).z, normals[3 * i + 2], 1e-4) << i;
    }
}

TEST(Winding, RepeatedTrianglesAreNotCounted)
{
    GltfBuilder builder;
    const int normals = builder.positions({0, 0, -1, 0, 0, -1, 0, 0, -1});
    builder.triangle({{"attributes", {{"NORMAL", normals}}}});
    builder.json["scenes"][0]["nodes"].push_back(builder.node({{"mesh", 0}}));
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->counts.duplicate_triangles, 1u);
    EXPECT_EQ(scene->mesh.positions.size(), 3u);
    EXPECT_EQ(flips(*scene),
              std::vector<std::string>{"1 of 1 triangles have normals against their winding; they were flipped"});
}

TEST(Winding, TheEmittingSideIsTheWindings)
{
    for (const float z : {1.0f, -1.0f})
    {
        const Result<SceneData> scene = build({.normal_z = z, .emits = true}).scene();
        ASSERT_TRUE(scene) << scene.error().message;
        const LightTables lights = buildLights(*scene);
        ASSERT_EQ(lights.lights.size(), 2u);
        for (const gpu::Light& light : lights.lights)
        {
            EXPECT_EQ(light.kind, gpu::kLightTriangle);
            EXPECT_GT(cross(light.p1 - light.p0, light.p2 - light.p0).z, 0);
        }
    }
}
} // namespace
