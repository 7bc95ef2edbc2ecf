#include "compiler/encode.h"
#include "compiler/linear.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using Triangles = std::vector<std::array<float, 9>>;

/// World positions of the triangles, corner by corner.
Triangles corners(const WorldMesh& mesh)
{
    Triangles result;
    for (const gpu::uvec3 t : mesh.triangles)
    {
        std::array<float, 9> c;
        size_t k = 0;
        for (const uint32_t v : {t.x, t.y, t.z})
            for (const float f : {mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z})
                c[k++] = f;
        result.push_back(c);
    }
    return result;
}

const std::vector<float> kQuad{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}; // a strip's order

TEST(Mesh, ListsStripsAndFansOfEveryIndexTypeGiveTheSameSurface)
{
    const Triangles want{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 0, 1, 0, 0, 1, 1, 0}};
    struct Case
    {
        int mode;
        std::vector<uint32_t> indices;
        Triangles want;
    };
    const Triangles fan{{0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 1, 1, 0, 0, 1, 0}};
    const std::vector<Case> cases{{4, {0, 1, 2, 2, 1, 3}, want}, {5, {0, 1, 2, 3}, want}, {6, {0, 1, 3, 2}, fan}};
    for (const Case& c : cases)
        for (const int type : {5121, 5123, 5125})
        {
            GltfBuilder builder;
            const std::vector<uint8_t> u8(c.indices.begin(), c.indices.end());
            const std::vector<uint16_t> u16(c.indices.begin(), c.indices.end());
            const int indices = type == 5121   ? builder.accessor(u8, "SCALAR", type, u8.size())
                                : type == 5123 ? builder.accessor(u16, "SCALAR", type, u16.size())
                                               : builder.accessor(c.indices, "SCALAR", type, c.indices.size());
            const int mesh = builder.mesh(
                {{"attributes", {{"POSITION", builder.positions(kQuad)}}}, {"mode", c.mode}, {"indices", indices}});
            builder.node({{"mesh", mesh}});
            const Result<SceneData> scene = builder.scene();
            ASSERT_TRUE(scene) << scene.error().message;
            EXPECT_EQ(corners(scene->mesh), c.want) << "mode " << c.mode << " type " << type;
        }
}

TEST(Mesh, StripWithoutIndicesTakesVerticesInOrder)
{
    GltfBuilder builder;
    builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", builder.positions(kQuad)}}}, {"mode", 5}})}});
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(corners(scene->mesh), (Triangles{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 0, 1, 0, 0, 1, 1, 0}}));
}

TEST(Mesh, QuantizedPositionsKeepTheirValuesAndAreScaledByTheNode)
{
    GltfBuilder builder;
    const int positions = builder.accessor(std::vector<int16_t>{0, 0, 0, 100, 0, 0, 0, 100, 0}, "VEC3", 5122, 3);
    builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", positions}}}})}, {"scale", {0.01, 0.01, 0.01}}});
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_NEAR(scene->mesh.positions[1].x, 1, 1e-6);
}

TEST(Mesh, PointsAndLinesAreDroppedWithAWarning)
{
    GltfBuilder builder;
    builder.triangle();
    builder.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->counts.dropped_primitives, 1u);
    ASSERT_EQ(scene->warnings.size(), 1u);
    EXPECT_NE(scene->warnings[0].message.find("lines"), std::string::npos);
}

TEST(Mesh, DegenerateAndDuplicateTrianglesAreRemovedAndCounted)
{
    GltfBuilder builder;
    // Same triangle again with its corners turned; its back side (another winding: kept); a repeated corner; a line.
    const std::vector<uint8_t> indices{0, 1, 2, 1, 2, 0, 0, 2, 1, 0, 0, 1, 0, 1, 3};
    const int accessor = builder.accessor(indices, "SCALAR", 5121, indices.size());
    const int positions = builder.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0});
    builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", accessor}})}});
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->mesh.triangles.size(), 2u);
    EXPECT_EQ(scene->counts.duplicate_triangles, 1u);
    EXPECT_EQ(scene->counts.degenerate_triangles, 2u);
    EXPECT_EQ(scene->mesh.positions.size(), scene->mesh.attributes.size());
    for (const gpu::uvec3 t : scene->mesh.triangles)
        EXPECT_LT(std::max({t.x, t.y, t.z}), scene->mesh.positions.size());
}

/// Two triangles that share the edge from (0,0,0) to (0,1,0), folded by `angle` there.
GltfBuilder folded(float angle)
{
    GltfBuilder builder;
    const float c = std::cos(angle);
    const float s = std::sin(angle);
    const int positions = builder.positions({0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 1, 0, 0, 0, 0, c, 0, -s});
    builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", positions}}}})}});
    return builder;
}

TEST(Mesh, MadeNormalsAreSmoothBelowTheCreaseAngleAndFlatAbove)
{
    const float pi = 3.14159265f;
    for (const float angle : {0.5f, 80 * pi / 180})
    {
        const Result<SceneData> scene = folded(angle).scene();
        ASSERT_TRUE(scene) << scene.error().message;
        EXPECT_EQ(scene->counts.generated_normals, 6u);
        const gpu::vec3 left{0, 0, 1};
        const gpu::vec3 right{std::sin(angle), 0, std::cos(angle)};
        const gpu::vec3 shared = angle < pi / 3 ? normalizeOr(left + right, {}) : left;
        const gpu::uvec3 t = scene->mesh.triangles[0];
        const gpu::vec3 at_edge = decodeNormal(scene->mesh.attributes[t.x].normal);
        const gpu::vec3 at_tip = decodeNormal(scene->mesh.attributes[t.z].normal);
        EXPECT_NEAR(dot(at_edge, shared), 1, 1e-6) << "angle " << angle;
        EXPECT_NEAR(dot(at_tip, left), 1, 1e-6) << "angle " << angle;
    }
}

TEST(Mesh, NonManifoldEdgesStillGetNormals)
{
    GltfBuilder builder; // three triangles on one edge, two of them in the same direction
    const int positions = builder.positions({0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, -1, 0, 0});
    const std::vector<uint8_t> indices{0, 2, 1, 0, 1, 3, 0, 1, 4};
    const int accessor = builder.accessor(indices, "SCALAR", 5121, indices.size());
    builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", accessor}})}});
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->mesh.triangles.size(), 3u);
    EXPECT_TRUE(scene->warnings.empty());
    for (const gpu::uvec3 t : scene->mesh.triangles)
        for (const uint32_t v : {t.x, t.y, t.z})
            EXPECT_NEAR(length(decodeNormal(scene->mesh.attributes[v].normal)), 1, 1e-5);
}

TEST(Mesh, NormalsWithoutDirectionAreReplacedByTheTriangles)
{
    GltfBuilder builder;
    const int normals = builder.accessor(std::vector<float>{0, 0, 0, 0, 0, 1, NAN, 0, 1}, "VEC3", 5126, 3);
    builder.triangle({{"attributes", {{"NORMAL", normals}}}});
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    for (const gpu::VertexAttributes& v : scene->mesh.attributes)
        EXPECT_NEAR(decodeNormal(v.normal).z, 1, 1e-6);
    ASSERT_EQ(scene->warnings.size(), 1u);
    EXPECT_NE(scene->warnings[0].message.find("2 vertex normals"), std::string::npos) << scene->warnings[0].message;
}

TEST(Mesh, TrianglesWithPositionsThatAreNotFiniteAreLeftOut)
{
    GltfBuilder builder;
    const int positions = builder.positions({0, 0, 0, INFINITY, 0, 0, 0, 1, 0, 1, 1, 0});
    const int indices = builder.accessor(std::vector<uint16_t>{0, 1, 2, 0, 3, 2}, "SCALAR", 5123, 6);
    builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}})}});
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->mesh.triangles.size(), 1u);
    ASSERT_EQ(scene->warnings.size(), 1u);
    EXPECT_EQ(scene->warnings[0].message, "1 of 2 triangles have vertices that are not finite");
}

/// A quad in the xy plane with a normal map; u runs right or left, v runs down.
GltfBuilder normalMapped(bool mirrored_half)
{
    GltfBuilder builder;
    const int texture = builder.texture(1, 1, {128, 128, 255, 255});
    builder.material({{"normalTexture", {{"index", texture}}}});
    const int positions = builder.positions({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 0, 0});
    const std::vector<float> uv{0, 1, 1, 1, 1, 0, 0, 0, mirrored_half ? 1.0f : -1.0f, 1};
    const int coordinates = builder.accessor(uv, "VEC2", 5126, 5);
    const std::vector<uint8_t> indices{0, 1, 2, 0, 2, 3, 0, 3, 4};
    const int accessor = builder.accessor(indices, "SCALAR", 5121, indices.size());
    builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", coordinates}}},
                                         {"indices", accessor},
                                         {"material", 0}})}});
    return builder;
}

TEST(Mesh, MadeTangentsFollowUWithThePositiveSignForUnmirroredCoordinates)
{
    const Result<SceneData> scene = normalMapped(false).scene();
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->counts.generated_tangents, 5u);
    for (const gpu::VertexAttributes& v : scene->mesh.attributes)
    {
        EXPECT_NEAR(decodeTangent(v.tangent).x, 1, 1e-4);
        EXPECT_EQ(v.tangent >> 16 & 1u, 0u);
    }
}

TEST(Mesh, MirroredCoordinatesSplitVerticesAndTurnTheSign)
{
    const Result<SceneData> scene = normalMapped(true).scene();
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->counts.generated_tangents, 7u);
    const gpu::uvec3 mirrored = scene->mesh.triangles[2];
    for (const uint32_t v : {mirrored.x, mirrored.y, mirrored.z})
    {
        EXPECT_NEAR(decodeTangent(scene->mesh.attributes[v].tangent).x, -1, 1e-4);
        EXPECT_EQ(scene->mesh.attributes[v].tangent >> 16 & 1u, 1u);
    }
}

TEST(Mesh, VertexColoursBecomeLinearHalfs)
{
    GltfBuilder builder;
    const std::vector<uint8_t> padded{255, 0, 51, 9, 255, 0, 51, 9, 255, 0, 51, 9}; // RGB and a byte of padding
    const int colors = builder.accessorOf(builder.view(padded.data(), padded.size(), 4), 0, "VEC3", 5121, 3, true);
    builder.triangle({{"attributes", {{"COLOR_0", colors}}}});
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    const gpu::uvec2 c = scene->mesh.attributes[1].color;
    EXPECT_EQ(decodeHalf(uint16_t(c.x)), 1);
    EXPECT_EQ(decodeHalf(uint16_t(c.x >> 16)), 0);
    EXPECT_NEAR(decodeHalf(uint16_t(c.y)), 0.2f, 1e-4);
    EXPECT_EQ(decodeHalf(uint16_t(c.y >> 16)), 1);
}
} // namespace
