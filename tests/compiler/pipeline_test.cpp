#include "compiler/compile.h"
#include "compiler/report.h"
#include "format/package_read.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace
{
std::string bytesOf(const std::filesystem::path& path)
{
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Two textured triangles, one of them emitting, below a normal map: every kind of chunk.
GltfBuilder richScene()
{
    GltfBuilder builder;
    const int texture = builder.texture(2, 2, {255, 0, 0, 255, 0, 255, 0, 0, 0, 0, 255, 255, 9, 9, 9, 255});
    builder.material({{"name", "leaf"},
                      {"alphaMode", "MASK"},
                      {"normalTexture", {{"index", texture}}},
                      {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    builder.material({{"name", "lamp"}, {"emissiveFactor", {1, 1, 1}}});
    const int uv = builder.accessor(std::vector<float>{0, 1, 1, 1, 0, 0}, "VEC2", 5126, 3);
    builder.triangle({{"material", 0}, {"attributes", {{"TEXCOORD_0", uv}}}});
    builder.triangle({{"material", 1}});
    builder.json["nodes"][1]["translation"] = {0, 0, 2};
    builder.json["scenes"][0]["nodes"] = {0, 1};
    builder.json["asset"]["generator"] = "by hand";
    return builder;
}

TEST(Pipeline, WritesAPackageThatTheReaderAccepts)
{
    const TemporaryFolder folder;
    richScene().writeGlb(folder / "scene.glb");
    CompileOptions options{.input = folder / "scene.glb", .output = folder / "scene.lumi"};
    options.views = {{.name = "mine", .position = {0, 0, 5}, .vertical_fov = 1}};
    options.default_light = DefaultLight::kOff; // the lamp shines on nothing
    const Result<CompileReport> report = compile(options);
    ASSERT_TRUE(report) << report.error().message;
    const auto package = package::Package::open(options.output);
    ASSERT_TRUE(package) << package.error().message;
    EXPECT_EQ(package->triangles().size(), 2u);
    EXPECT_EQ(package->materials().size(), 2u);
    EXPECT_EQ(package->lights().size(), 1u);
    EXPECT_EQ(package->triangles()[1].light, 0u);
    EXPECT_EQ(package->textureRefs().size(), 2u);
    EXPECT_EQ(package->meta().texture_pages()->size(), 2u); // colour and data
    EXPECT_TRUE(package->meta().has_alpha());
    EXPECT_EQ(package->meta().cameras()->Get(0)->name()->str(), "mine");
    EXPECT_EQ(package->meta().material_names()->Get(1)->str(), "lamp");
    EXPECT_EQ(package->meta().provenance()->source()->str(), "scene.glb");
    EXPECT_EQ(package->meta().provenance()->generator()->str(), "by hand");
}

TEST(Pipeline, EqualInputAndOptionsGiveEqualBytes)
{
    const TemporaryFolder folder;
    richScene().writeGltf(folder / "scene.gltf");
    for (const char* name : {"a.lumi", "b.lumi"})
    {
        const Result<CompileReport> report = compile({.input = folder / "scene.gltf", .output = folder / name});
        ASSERT_TRUE(report) << report.error().message;
    }
    EXPECT_EQ(bytesOf(folder / "a.lumi"), bytesOf(folder / "b.lumi"));
}

TEST(Pipeline, ASceneWithoutLightGetsAStatedSkyAndSunUnlessToldNotTo)
{
    const TemporaryFolder folder;
    GltfBuilder builder;
    builder.triangle();
    builder.writeGltf(folder / "dark.gltf");
    for (const bool default_light : {true, false})
    {
        CompileOptions options{.input = folder / "dark.gltf", .output = folder / "dark.lumi"};
        options.default_light = default_light ? DefaultLight::kAuto : DefaultLight::kOff;
        const Result<CompileReport> report = compile(options);
        ASSERT_TRUE(report) << report.error().message;
        EXPECT_EQ(report->meta.environment != nullptr, default_light);
        EXPECT_EQ(report->directional_lights, default_light ? 1u : 0u);
        EXPECT_EQ(report->meta.provenance->warnings.size(), 1u);
        const auto package = package::Package::open(options.output);
        ASSERT_TRUE(package) << package.error().message;
        EXPECT_EQ(package->lights().size(), default_light ? 2u : 0u);
    }
}

TEST(Pipeline, TheMadeCameraSeesTheWholeScene)
{
    const TemporaryFolder folder;
    richScene().writeGltf(folder / "scene.gltf");
    const Result<CompileReport> report = compile({.input = folder / "scene.gltf", .output = folder / "scene.lumi"});
    ASSERT_TRUE(report) << report.error().message;
    ASSERT_EQ(report->meta.cameras.size(), 1u);
    const lumicut::fb::CameraT& camera = *report->meta.cameras[0];
    EXPECT_EQ(camera.name, "default");
    const auto vec = [](const lumicut::fb::Vec3& v) { return gpu::vec3{v.x(), v.y(), v.z()}; };
    const gpu::vec3 low = vec(*report->meta.bounds_min), high = vec(*report->meta.bounds_max);
    const float limit = std::cos(camera.vertical_fov / 2);
    for (int corner = 0; corner < 8; ++corner)
    {
        const gpu::vec3 p{corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z};
        EXPECT_GE(dot(normalizeOr(p - vec(*camera.position), {}), vec(*camera.forward)), limit - 1e-5f);
    }
}

TEST(Pipeline, AFailureLeavesNoOutputBehind)
{
    const TemporaryFolder folder;
    GltfBuilder builder = richScene();
    builder.json["images"][0] = {{"uri", "gone.png"}};
    builder.writeGltf(folder / "scene.gltf");
    CompileOptions options{.input = folder / "scene.gltf", .output = folder / "scene.lumi"};
    options.strict = true; // found late
    const Result<CompileReport> report = compile(options);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ExitCode::kInvalid);
    ASSERT_EQ(report.error().details.size(), 1u);
    EXPECT_NE(report.error().details[0].find("gone.png"), std::string::npos);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1); // the scene alone
}

TEST(Pipeline, TheReportIsJsonWithTheStatedSchema)
{
    const TemporaryFolder folder;
    richScene().writeGltf(folder / "scene.gltf");
    const CompileOptions options{.input = folder / "scene.gltf", .output = folder / "scene.lumi"};
    const Result<CompileReport> report = compile(options);
    ASSERT_TRUE(report) << report.error().message;
    const nlohmann::json json = nlohmann::json::parse(reportJson(*report, options));
    EXPECT_EQ(json["schema"], "lumicut-compile-report/1");
    EXPECT_EQ(json["triangles"], 2);
    EXPECT_EQ(json["origin"], nlohmann::json({0, 0, 0}));
    EXPECT_EQ(json["unit"], 1);
    EXPECT_EQ(json["lights"]["emissive_triangles"], 1);
    EXPECT_EQ(json["texture_pages"].size(), 2u);
    uint64_t stored = 0;
    for (const auto& chunk : json["chunks"])
        stored += chunk["stored_bytes"].get<uint64_t>();
    EXPECT_GT(stored, 0u);
    EXPECT_LE(stored, std::filesystem::file_size(options.output));
    EXPECT_NE(summaryText(*report, options).find("triangles  2"), std::string::npos);
    EXPECT_NE(summaryText(*report, options).find("origin     (0, 0, 0) m, unit 1 m"), std::string::npos);
}
} // namespace
