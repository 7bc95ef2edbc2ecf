// The demo scenes: what the generator promises, read back from the bytes it writes.
#include "tests/tools/run_program.h"
#include "tools/scenes/scenes.h"

#include <gtest/gtest.h>
#include <stb_image.h>

#include <array>
#include <cstring>
#include <map>

namespace
{

using nlohmann::json;

/// A .glb taken apart again, by the specification and not by the writer's own code.
struct Glb
{
    json content;
    std::vector<uint8_t> binary;

    explicit Glb(const std::vector<uint8_t>& bytes)
    {
        EXPECT_EQ(std::memcmp(bytes.data(), "glTF\x02\0\0\0", 8), 0);
        EXPECT_EQ(word(bytes, 8), bytes.size());
        const size_t json_bytes = word(bytes, 12);
        EXPECT_EQ(word(bytes, 16), 0x4e4f534au);
        EXPECT_EQ(json_bytes % 4, 0u);
        content = json::parse(bytes.begin() + 20, bytes.begin() + 20 + std::ptrdiff_t(json_bytes));
        const size_t at = 20 + json_bytes;
        EXPECT_EQ(word(bytes, at + 4), 0x004e4942u);
        binary.assign(bytes.begin() + std::ptrdiff_t(at) + 8, bytes.end());
        EXPECT_EQ(word(bytes, at), binary.size());
        EXPECT_EQ(content["buffers"][0]["byteLength"], binary.size());
    }

    static size_t word(const std::vector<uint8_t>& bytes, size_t at)
    {
        return bytes[at] | size_t(bytes[at + 1]) << 8 | size_t(bytes[at + 2]) << 16 | size_t(bytes[at + 3]) << 24;
    }

    const uint8_t* view(const json& buffer_view, size_t needed) const
    {
        EXPECT_LE(buffer_view["byteOffset"].get<size_t>() + buffer_view["byteLength"].get<size_t>(), binary.size());
        EXPECT_GE(buffer_view["byteLength"].get<size_t>(), needed);
        return binary.data() + buffer_view["byteOffset"].get<size_t>();
    }

    template <typename T>
    std::vector<T> accessor(size_t index) const
    {
        const json& description = content["accessors"][index];
        std::vector<T> values(description["count"].get<size_t>());
        std::memcpy(values.data(),
                    view(content["bufferViews"][description["bufferView"].get<size_t>()], values.size() * sizeof(T)),
                    values.size() * sizeof(T));
        return values;
    }
};

struct Part
{
    std::string name;
    bool double_sided;
    std::vector<Vec3> positions, normals;
    std::vector<Vec2> uvs;
    std::vector<uint32_t> indices;
};

std::vector<Part> parts(const Glb& glb)
{
    std::vector<Part> result;
    for (const json& mesh : glb.content["meshes"])
    {
        for (const json& primitive : mesh["primitives"])
        {
            const json& attributes = primitive["attributes"];
            const json& material = glb.content["materials"][primitive["material"].get<size_t>()];
            result.push_back({mesh["name"], material.value("doubleSided", false),
                              glb.accessor<Vec3>(attributes["POSITION"]), glb.accessor<Vec3>(attributes["NORMAL"]),
                              glb.accessor<Vec2>(attributes["TEXCOORD_0"]),
                              glb.accessor<uint32_t>(primitive["indices"])});
        }
    }
    return result;
}

struct SceneCase
{
    const char* name;
    GltfWriter (*build)();
    uint64_t least_triangles, most_triangles;
    size_t texture_count;
    std::vector<std::string> cameras;
};

class Scenes : public testing::TestWithParam<SceneCase>
{
protected:
    const std::vector<uint8_t> bytes_ = GetParam().build().glb();
    const Glb glb_{bytes_};
};

TEST_P(Scenes, SameBytesEveryTime)
{
    EXPECT_EQ(GetParam().build().glb(), bytes_);
}

TEST_P(Scenes, SaysWhereItComesFromAndNamesItsCameras)
{
    EXPECT_EQ(glb_.content["asset"]["copyright"], "CC0 1.0");
    EXPECT_EQ(glb_.content["asset"]["generator"], "lumicut-scenes");
    std::vector<std::string> cameras;
    for (const json& node : glb_.content["nodes"])
        if (node.contains("camera"))
            cameras.push_back(node["name"]);
    EXPECT_EQ(cameras, GetParam().cameras);
}

TEST_P(Scenes, TriangleCountIsInRangeAndAsReported)
{
    uint64_t count = 0;
    for (const json& node : glb_.content["nodes"])
    {
        if (!node.contains("mesh"))
            continue;
        const json& primitive = glb_.content["meshes"][node["mesh"].get<size_t>()]["primitives"][0];
        count += glb_.content["accessors"][primitive["indices"].get<size_t>()]["count"].get<uint64_t>() / 3;
    }
    EXPECT_EQ(count, GetParam().build().triangleCount());
    EXPECT_GE(count, GetParam().least_triangles);
    EXPECT_LE(count, GetParam().most_triangles);
}

TEST_P(Scenes, VerticesAreFiniteNormalsUnitIndicesInRangeAndBoundsTight)
{
    for (const Part& part : parts(glb_))
    {
        ASSERT_EQ(part.positions.size(), part.normals.size()) << part.name;
        ASSERT_EQ(part.positions.size(), part.uvs.size()) << part.name;
        ASSERT_EQ(part.indices.size() % 3, 0u) << part.name;
        for (size_t i = 0; i < part.positions.size(); ++i)
        {
            ASSERT_TRUE(std::isfinite(length(part.positions[i]))) << part.name;
            ASSERT_NEAR(length(part.normals[i]), 1.0f, 1e-5f) << part.name;
            ASSERT_TRUE(std::isfinite(part.uvs[i].x) && std::isfinite(part.uvs[i].y)) << part.name;
        }
        for (uint32_t index : part.indices)
            ASSERT_LT(index, part.positions.size()) << part.name;
    }
}

TEST_P(Scenes, WindingAgreesWithNormalsAndNoTriangleIsDegenerate)
{
    for (const Part& part : parts(glb_))
    {
        for (size_t i = 0; i < part.indices.size(); i += 3)
        {
            const uint32_t a = part.indices[i], b = part.indices[i + 1], c = part.indices[i + 2];
            const Vec3 p = part.positions[a];
            const Vec3 face = cross(part.positions[b] - p, part.positions[c] - p);
            ASSERT_GT(length(face), 1e-10f) << part.name << " triangle " << i / 3;
            const Vec3 shading = part.normals[a] + part.normals[b] + part.normals[c];
            ASSERT_GT(dot(normalize(face), normalize(shading)), 0.3f)
                << part.name << " triangle " << i / 3 << " at " << p.x << " " << p.y << " " << p.z;
        }
    }
}

/// Refraction and absorption only make sense in closed bodies: every edge is shared by two triangles, once each way.
TEST_P(Scenes, RefractingBodiesAreClosed)
{
    for (const json& mesh : glb_.content["meshes"])
    {
        const json& primitive = mesh["primitives"][0];
        const json& material = glb_.content["materials"][primitive["material"].get<size_t>()];
        if (!material.contains("extensions") || !material["extensions"].contains("KHR_materials_volume"))
            continue;
        const std::vector<Vec3> positions = glb_.accessor<Vec3>(primitive["attributes"]["POSITION"]);
        const std::vector<uint32_t> indices = glb_.accessor<uint32_t>(primitive["indices"]);
        std::map<std::array<float, 3>, int> ids;
        const auto id = [&](uint32_t index)
        {
            const Vec3 p = positions[index];
            return ids.try_emplace({p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}, int(ids.size())).first->second; // + 0: no -0
        };
        std::map<std::pair<int, int>, int> edges;
        for (size_t i = 0; i < indices.size(); i += 3)
            for (size_t j = 0; j < 3; ++j)
                ++edges[{id(indices[i + j]), id(indices[i + (j + 1) % 3])}];
        ASSERT_FALSE(edges.empty());
        for (const auto& [edge, count] : edges)
        {
            ASSERT_EQ(count, 1) << mesh["name"];
            ASSERT_EQ(edges.count({edge.second, edge.first}), 1u) << mesh["name"];
        }
    }
}

TEST_P(Scenes, TexturesDecode)
{
    const json images = glb_.content.value("images", json::array());
    EXPECT_EQ(images.size(), GetParam().texture_count);
    for (const json& image : images)
    {
        const json& view = glb_.content["bufferViews"][image["bufferView"].get<size_t>()];
        const int bytes = view["byteLength"];
        int width = 0, height = 0, channels = 0;
        unsigned char* texels = stbi_load_from_memory(glb_.view(view, 0), bytes, &width, &height, &channels, 3);
        ASSERT_NE(texels, nullptr) << image["name"];
        EXPECT_GE(width, 256) << image["name"];
        EXPECT_EQ(width, height) << image["name"];
        stbi_image_free(texels);
    }
}

TEST_P(Scenes, StaysUnderEightMegabytes)
{
    EXPECT_LT(bytes_.size(), 8u << 20);
}

INSTANTIATE_TEST_SUITE_P(All, Scenes,
                         testing::Values(SceneCase{"cornell", cornellScene, 30, 100, 0, {"front"}},
                                         SceneCase{"caustics", causticsScene, 30000, 100000, 0, {"table"}},
                                         SceneCase{
                                             "atrium", atriumScene, 50000, 100000, 13, {"hall", "gallery", "glass"}}),
                         [](const auto& test) { return std::string(test.param.name); });

/// Signed volume by the divergence theorem: right only where the mesh is closed and wound outwards.
double volume(const Mesh& mesh)
{
    double sum = 0;
    for (size_t i = 0; i < mesh.indices.size(); i += 3)
        sum += double(dot(mesh.positions[mesh.indices[i]],
                          cross(mesh.positions[mesh.indices[i + 1]], mesh.positions[mesh.indices[i + 2]]))) /
               6;
    return sum;
}

TEST(Shapes, BoxHasItsVolumeAndABevelTakesOffItsPrisms)
{
    EXPECT_NEAR(volume(box({1, 2, 3}, {2, 4, 6})), 6, 1e-5);
    // Each edge loses a prism of section b^2 / 2; at the eight corners these overlap, by less than b^3 each.
    const double b = 0.1, edges = 0.5 * b * b * 4 * (1 + 2 + 3);
    EXPECT_NEAR(volume(box({0, 0, 0}, {1, 2, 3}, 0.1f)), 6 - edges, 8 * b * b * b);
    EXPECT_LT(volume(box({0, 0, 0}, {1, 2, 3}, 0.1f)), 6);
}

TEST(Shapes, SphereAndRingHaveTheirVolumes)
{
    const double pi = 3.14159265358979;
    EXPECT_NEAR(volume(sphere(0.5f, 192, 96)), 4.0 / 3.0 * pi * 0.125, 1e-3);
    const std::vector<Vec2> square = {{0.9f, -0.1f}, {1.1f, -0.1f}, {1.1f, 0.1f}, {0.9f, 0.1f}};
    EXPECT_NEAR(volume(ring(square, 256)), 2 * pi * 1.0 * 0.04, 1e-3); // Pappus
}

TEST(ScenesProgram, WritesWhatItIsAskedForAndCountsTriangles)
{
    const TemporaryFolder folder;
    const ProgramRun run = runProgram(LUMICUT_SCENES, (folder / "new").string() + " cornell");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("cornell.glb: "), std::string::npos) << run.out;
    EXPECT_NE(run.out.find(" triangles"), std::string::npos) << run.out;
    const std::vector<uint8_t> expected = cornellScene().glb();
    EXPECT_EQ(fileBytes(folder / "new/cornell.glb"), std::string(expected.begin(), expected.end()));
    EXPECT_FALSE(std::filesystem::exists(folder / "new/atrium.glb"));
}

TEST(ScenesProgram, RefusesUnknownScenesAndUnwritableFolders)
{
    const TemporaryFolder folder;
    const ProgramRun unknown = runProgram(LUMICUT_SCENES, folder.path().string() + " teapot");
    EXPECT_EQ(unknown.exit_code, 1);
    EXPECT_NE(unknown.err.find("teapot"), std::string::npos) << unknown.err;
    EXPECT_EQ(runProgram(LUMICUT_SCENES, "").exit_code, 1);

    std::ofstream(folder / "file") << "in the way";
    const ProgramRun blocked = runProgram(LUMICUT_SCENES, (folder / "file").string() + " cornell");
    EXPECT_EQ(blocked.exit_code, 2);
    EXPECT_NE(blocked.err.find("error:"), std::string::npos) << blocked.err;
    EXPECT_EQ(blocked.out, "");
}

} // namespace
