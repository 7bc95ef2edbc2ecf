// The scenes: what the generator promises, read back from the bytes it writes.
#include "tests/tools/run_program.h"
#include "tools/scenes/scenes.h"

#include <gtest/gtest.h>
#include <stb_image.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <set>

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

using Double3 = std::array<double, 3>;

Double3 cross(const Double3& a, const Double3& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Double3& a, const Double3& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Triangles and cameras as the nodes place them: in doubles, scale and shift of parents, no turned parents.
struct Placed
{
    std::vector<std::array<Double3, 3>> triangles;
    std::vector<std::pair<Double3, Double3>> cameras; // eye, direction of view
    Double3 low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30};

    explicit Placed(const Glb& glb)
    {
        for (const json& index : glb.content["scenes"][0]["nodes"])
            add(glb, glb.content["nodes"][index.get<size_t>()], {}, 1);
    }

    void add(const Glb& glb, const json& node, const Double3& parent_shift, double parent_scale)
    {
        const Double3 shift = node.value("translation", Double3{});
        const std::array<double, 4> turn = node.value("rotation", std::array<double, 4>{0, 0, 0, 1});
        const double scale = parent_scale * (node.contains("scale") ? node["scale"][0].get<double>() : 1);
        const auto turned = [&](const Double3& v)
        {
            const Double3 axis{turn[0], turn[1], turn[2]}, once = cross(axis, v), twice = cross(axis, once);
            Double3 result;
            for (size_t i = 0; i < 3; ++i)
                result[i] = v[i] + 2 * (turn[3] * once[i] + twice[i]);
            return result;
        };
        Double3 origin;
        for (size_t i = 0; i < 3; ++i)
            origin[i] = parent_shift[i] + parent_scale * shift[i];
        if (node.contains("camera"))
            cameras.emplace_back(origin, turned({0, 0, -1}));
        for (const json& child : node.value("children", json::array()))
            add(glb, glb.content["nodes"][child.get<size_t>()], origin, scale);
        if (!node.contains("mesh"))
            return;
        const json& primitive = glb.content["meshes"][node["mesh"].get<size_t>()]["primitives"][0];
        const auto positions = glb.accessor<Vec3>(primitive["attributes"]["POSITION"]);
        const auto indices = glb.accessor<uint32_t>(primitive["indices"]);
        for (size_t i = 0; i < indices.size(); ++i)
        {
            const Vec3 local = positions[indices[i]];
            const Double3 v = turned({local.x, local.y, local.z});
            if (i % 3 == 0)
                triangles.emplace_back();
            for (size_t k = 0; k < 3; ++k)
            {
                const double value = origin[k] + scale * v[k];
                triangles.back()[i % 3][k] = value;
                low[k] = std::min(low[k], value);
                high[k] = std::max(high[k], value);
            }
        }
    }

    bool isHit(const Double3& eye, const Double3& direction) const
    {
        const auto minus = [](const Double3& a, const Double3& b) {
            return Double3{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
        };
        return std::ranges::any_of(triangles, [&](const std::array<Double3, 3>& t) { // Moeller and Trumbore
            const Double3 e1 = minus(t[1], t[0]), e2 = minus(t[2], t[0]), o = minus(eye, t[0]);
            const Double3 p = cross(direction, e2), q = cross(o, e1);
            const double d = dot(e1, p), u = dot(o, p) / d, v = dot(direction, q) / d;
            return u >= 0 && v >= 0 && u + v <= 1 && dot(e2, q) / d > 0;
        });
    }
};

struct SceneCase
{
    const char* name;
    uint64_t least_triangles, most_triangles;
    size_t texture_count;
    std::vector<std::string> cameras;
    bool indoors = true;          // cameras are within the bounds of the geometry
    bool against_winding = false; // normals
};

GltfWriter build(std::string_view name)
{
    for (const Scene& scene : allScenes())
        if (scene.name == name)
            return scene.build();
    ADD_FAILURE() << "no scene " << name;
    return GltfWriter();
}

class Scenes : public testing::TestWithParam<SceneCase>
{
protected:
    const std::vector<uint8_t> bytes_ = build(GetParam().name).glb();
    const Glb glb_{bytes_};
};

TEST_P(Scenes, SameBytesEveryTime)
{
    EXPECT_EQ(build(GetParam().name).glb(), bytes_);
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
    EXPECT_EQ(count, build(GetParam().name).triangleCount());
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
            ASSERT_GT(dot(normalize(face), normalize(shading)) * (GetParam().against_winding ? -1.0f : 1.0f), 0.3f)
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

TEST_P(Scenes, CamerasSeeSomethingFromWhereTheyShouldBe)
{
    const Placed placed(glb_);
    ASSERT_FALSE(placed.cameras.empty());
    for (const auto& [eye, forward] : placed.cameras)
    {
        EXPECT_TRUE(placed.isHit(eye, forward));
        if (GetParam().indoors)
            for (int axis = 0; axis < 3; ++axis)
            {
                EXPECT_GT(eye[axis], placed.low[axis]) << axis;
                EXPECT_LT(eye[axis], placed.high[axis]) << axis;
            }
    }
}

TEST_P(Scenes, Compiles)
{
    const TemporaryFolder folder;
    std::ofstream(folder / "scene.glb", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes_.data()), std::streamsize(bytes_.size()));
    const ProgramRun run =
        runProgram(LUMICUT_COMPILE, (folder / "scene.glb").string() + " -q -o " + (folder / "scene.lumi").string());
    EXPECT_EQ(run.exit_code, 0) << run.err;
}

const SceneCase kCases[] = {
    {"cornell", 30, 100, 0, {"front"}, false},
    {"caustics", 30000, 100000, 0, {"table"}},
    {"materials", 70000, 80000, 0, {"row"}},
    {"atrium", 50000, 100000, 13, {"hall", "gallery", "glass"}},
    {"sheets", 30, 30, 0, {"inside"}},
    {"small", 30, 30, 0, {"inside"}},
    {"large", 30, 30, 0, {"inside"}},
    {"slot", 30, 30, 0, {"inside"}},
    {"bright80", 14, 14, 0, {"inside"}},
    {"bright90", 14, 14, 0, {"inside"}},
    {"bright95", 14, 14, 0, {"inside"}},
    {"neighbours", 26, 26, 0, {"dim"}},
    {"neighbours_alone", 24, 24, 0, {"dim"}},
    {"plain0", 56, 56, 0, {"inside"}},
    {"plain1", 58, 58, 0, {"inside"}},
    {"plain10", 58, 58, 0, {"inside"}},
    {"far", 900, 1100, 0, {"court"}},
    {"far_local", 900, 1100, 0, {"court"}},
    {"decal", 8, 8, 1, {"front"}, false},
    {"decal_none", 6, 6, 1, {"front"}, false},
    {"terminator", 1500, 2500, 0, {"front"}, false},
    {"terminator_fine", 27000, 28000, 0, {"front"}, false},
    {"flipped", 3900, 4100, 0, {"corner"}, false, true},
    {"flipped_agreed", 3900, 4100, 0, {"corner"}, false},
    {"door", 100, 130, 0, {"room"}},
    {"lamp", 1000, 1200, 0, {"corner"}},
    {"walker", 8000, 9000, 0, {"side"}},
    {"ball", 25000, 26000, 0, {"front"}},
    {"shield", 16, 16, 0, {"floor"}, false},
    {"shield_unlit", 16, 16, 0, {"floor"}, false},
};
INSTANTIATE_TEST_SUITE_P(All, Scenes, testing::ValuesIn(kCases),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(SceneList, EachOfTheListIsTestedAndNamedOnce)
{
    std::vector<std::string> listed, tested;
    for (const Scene& scene : allScenes())
        listed.push_back(scene.name);
    for (const SceneCase& scene : kCases)
        tested.push_back(scene.name);
    EXPECT_EQ(listed, tested);
    EXPECT_EQ(std::set(listed.begin(), listed.end()).size(), listed.size());
}

TEST(SceneList, MapCoordinatesKeepTheirLastDigit)
{
    const std::vector<double> expected = {691607.4, 518.3, -5334758.9}; // no float is within a centimetre of the last
    EXPECT_EQ(Glb(build("far").glb()).content["nodes"].back()["translation"].get<std::vector<double>>(), expected);
}

TEST(SceneList, TwinsDifferInTheirLightOrPlaceAlone)
{
    const auto meshes = [](std::string_view name) { return Glb(build(name).glb()).content["meshes"]; };
    EXPECT_EQ(meshes("far"), meshes("far_local"));
    EXPECT_EQ(meshes("small"), meshes("sheets"));
    EXPECT_EQ(meshes("large"), meshes("sheets"));
    EXPECT_EQ(meshes("shield"), meshes("shield_unlit"));
}

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
