#include "compiler/encode.h"
#include "compiler/linear.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

namespace
{
void expectNear(gpu::vec3 got, gpu::vec3 want, float tolerance = 1e-6f)
{
    EXPECT_NEAR(got.x, want.x, tolerance);
    EXPECT_NEAR(got.y, want.y, tolerance);
    EXPECT_NEAR(got.z, want.z, tolerance);
}

gpu::vec3 faceNormal(const WorldMesh& mesh, size_t i)
{
    const gpu::uvec3 t = mesh.triangles[i];
    return normalizeOr(cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]), {});
}

TEST(Hierarchy, CombinesTranslationRotationScaleAndMatrices)
{
    // Parent: matrix, moves by (10, 0, 0). Child: quarter turn about y after doubling, then up by 1.
    GltfBuilder builder;
    builder.triangle();
    builder.json["nodes"][0].update({{"translation", {0, 1, 0}},
                                     {"rotation", {0, 0.7071067811865476, 0, 0.7071067811865476}},
                                     {"scale", {2, 2, 2}}});
    builder.node({{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1}}, {"children", {0}}});
    builder.json["scenes"][0]["nodes"] = {1};
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    expectNear(scene->mesh.positions[0], {10, 1, 0});
    expectNear(scene->mesh.positions[1], {10, 1, -2}); // +x turned a quarter about y is -z
    expectNear(scene->mesh.positions[2], {10, 3, 0});
}

TEST(Hierarchy, MirroringFlipsWindingAndKeepsNormalsOutside)
{
    GltfBuilder builder;
    const int normals = builder.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126, 3);
    const int tangents = builder.accessor(std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4", 5126, 3);
    builder.triangle({{"attributes", {{"NORMAL", normals}, {"TANGENT", tangents}}}});
    builder.json["nodes"][0]["scale"] = {-1, 1, 1};
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    expectNear(faceNormal(scene->mesh, 0), {0, 0, 1});
    const gpu::VertexAttributes& vertex = scene->mesh.attributes[0];
    expectNear(decodeNormal(vertex.normal), {0, 0, 1}, 1e-4f);
    expectNear(decodeTangent(vertex.tangent), {-1, 0, 0}, 1e-4f);
    // Mirrored, cross(normal, tangent) points down where the picture's up is still up: the sign turns.
    EXPECT_NE(vertex.tangent & (1u << 16), 0u);
}

TEST(Hierarchy, NormalsFollowNonUniformScale)
{
    GltfBuilder builder;
    const float h = 0.70710678f;
    const int normals = builder.accessor(std::vector<float>{h, h, 0, h, h, 0, h, h, 0}, "VEC3", 5126, 3);
    builder.triangle({{"attributes", {{"NORMAL", normals}}}});
    builder.json["nodes"][0]["scale"] = {2, 1, 1};
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    expectNear(decodeNormal(scene->mesh.attributes[0].normal), normalizeOr({0.5f, 1, 0}, {}),
               1e-4f); // inverse transpose
}

TEST(Hierarchy, EveryInstanceIsAnObjectOfItsOwn)
{
    GltfBuilder builder;
    builder.triangle();
    const int offsets = builder.accessor(std::vector<float>{0, 0, 0, 5, 0, 0, 9, 0, 0}, "VEC3", 5126, 3);
    builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = offsets;
    builder.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->mesh.triangles.size(), 3u);
    EXPECT_EQ(scene->mesh.objects, (std::vector<uint32_t>{0, 1, 2}));
    EXPECT_EQ(scene->mesh.object_count, 3u);
    expectNear(scene->mesh.positions[3], {5, 0, 0});
}

TEST(Hierarchy, HiddenNodesHideTheirChildren)
{
    GltfBuilder builder;
    builder.triangle();
    builder.triangle();
    builder.node({{"children", {1}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
    builder.json["scenes"][0]["nodes"] = {0, 2};
    builder.json["nodes"][1]["translation"] = {3, 0, 0};
    const Result<SceneData> scene = builder.scene();
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->mesh.triangles.size(), 1u);
    expectNear(scene->mesh.positions[0], {0, 0, 0});
}

TEST(Hierarchy, ACycleLeavesNothingToDraw)
{
    for (const int child : {0, 1}) // its own child, its parent's parent
    {
        GltfBuilder builder;
        builder.triangle();
        builder.node({{"children", {0}}});
        builder.json["scenes"][0]["nodes"] = {1};
        builder.json["nodes"][0]["children"] = {child};
        const Result<SceneData> scene = builder.scene();
        ASSERT_FALSE(scene);
        EXPECT_EQ(scene.error().code, ExitCode::kInvalid);
    }
}

TEST(Hierarchy, MatricesMayBeAffineButForRoundingAndNotProjective)
{
    const auto place = [](const std::vector<double>& last_row) -> std::optional<gpu::vec3>
    {
        GltfBuilder builder;
        builder.triangle();
        std::vector<double> m{2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 4, 0, 0, 1};
        for (size_t i = 0; i < 4; ++i)
            m[4 * i + 3] = last_row[i];
        builder.json["nodes"][0]["matrix"] = m;
        const Result<SceneData> scene = builder.scene();
        if (!scene)
        {
            EXPECT_EQ(scene.error().code, ExitCode::kInvalid);
            return std::nullopt;
        }
        return scene->mesh.positions[1];
    };
    for (const std::vector<double>& row :
         {std::vector<double>{0, 0, 0, 1}, {1e-7, -2e-7, 0, 1}, {0, 0, 0, 0.9999999}, {3e-8, 0, 0, 1.0000002}})
    {
        const auto seen = place(row);
        ASSERT_TRUE(seen) << row[0] << " " << row[3];
        EXPECT_NEAR(seen->x, 6, 1e-5);
    }
    EXPECT_NEAR(place({0, 0, 0, 2}).value_or(gpu::vec3{}).x, 3, 1e-6); // a scale by one half
    for (const std::vector<double>& row :
         {std::vector<double>{0, 0, -1, 0}, {0.1, 0, 0, 1}, {0, 0, 0, 0}, {0, 0.01, 0, 1}})
        EXPECT_FALSE(place(row)) << row[0] << " " << row[3];
}

TEST(Hierarchy, CamerasHaveTheFilesNearAndFarPlanes)
{
    const auto camera = [](const char* type, const nlohmann::json& lens) -> std::optional<CameraView>
    {
        GltfBuilder builder;
        builder.triangle();
        builder.json["cameras"] = {{{"type", type}, {type, lens}}};
        builder.json["nodes"][0]["camera"] = 0;
        const auto imported = builder.import();
        return imported ? std::optional(imported->scene.cameras[0]) : std::nullopt;
    };
    const auto endless = camera("perspective", {{"yfov", 1}, {"znear", 0.5}});
    ASSERT_TRUE(endless);
    EXPECT_EQ(endless->near_plane, 0.5f);
    EXPECT_EQ(endless->far_plane, 0);
    const auto bounded = camera("perspective", {{"yfov", 1}, {"znear", 0.5}, {"zfar", 8}});
    ASSERT_TRUE(bounded);
    EXPECT_EQ(bounded->far_plane, 8);
    const auto parallel = camera("orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 3}});
    ASSERT_TRUE(parallel);
    EXPECT_EQ(parallel->near_plane, 0);
    EXPECT_EQ(parallel->far_plane, 3);
    const auto crossed = camera("perspective", {{"yfov", 1}, {"znear", 8}, {"zfar", 0.5}});
    ASSERT_TRUE(crossed);
    EXPECT_EQ(crossed->near_plane, 8);
    EXPECT_EQ(crossed->far_plane, 0); // none
    const auto behind = camera("orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", -1}, {"zfar", 3}});
    ASSERT_TRUE(behind);
    EXPECT_EQ(behind->near_plane, 0);
}

TEST(Hierarchy, SurvivesAChainOfAHundredThousandNodes)
{
    GltfBuilder builder;
    builder.triangle();
    constexpr int kDepth = 100000;
    for (int i = 1; i <= kDepth; ++i)
        builder.node({{"children", {i - 1}}});
    builder.json["scenes"][0]["nodes"] = {kDepth};
    const auto imported = builder.import();
    ASSERT_TRUE(imported) << imported.error().message;
    EXPECT_EQ(imported->instances.size(), 1u);
}

TEST(Hierarchy, LightsAndCamerasLookAlongTheirNodesMinusZ)
{
    GltfBuilder builder;
    builder.triangle();
    builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"},
         {"intensity", 3},
         {"color", {1, 0.5, 0}},
         {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.3}}}}};
    builder.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
    // A quarter turn about x: -z becomes +y... up (+y) becomes +z.
    builder.node({{"translation", {1, 2, 3}},
                  {"rotation", {0.7071067811865476, 0, 0, 0.7071067811865476}},
                  {"scale", {4, 4, 4}},
                  {"camera", 0},
                  {"name", "eye"},
                  {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    builder.json["scenes"][0]["nodes"] = {0, 1};
    const auto imported = builder.import();
    ASSERT_TRUE(imported) << imported.error().message;
    ASSERT_EQ(imported->scene.lights.size(), 1u);
    const PunctualLight& light = imported->scene.lights[0];
    EXPECT_EQ(light.kind, gpu::kLightSpot);
    expectNear(toFloat(light.position), {1, 2, 3});
    expectNear(light.direction, {0, 1, 0});
    expectNear(light.intensity, {3, 1.5f, 0});
    EXPECT_FLOAT_EQ(light.inner_cone, 0.1f);
    EXPECT_FLOAT_EQ(light.outer_cone, 0.3f);
    ASSERT_EQ(imported->scene.cameras.size(), 1u);
    const CameraView& camera = imported->scene.cameras[0];
    EXPECT_EQ(camera.name, "eye");
    expectNear(camera.forward, {0, 1, 0});
    expectNear(camera.up, {0, 0, 1});
    EXPECT_FLOAT_EQ(camera.vertical_fov, 0.8f);
}
} // namespace
