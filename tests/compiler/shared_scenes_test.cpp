#include "compiler/compile.h"
#include "format/package_read.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace
{
const std::filesystem::path kScenes = std::filesystem::path(LUMICUT_SHARED_DIR) / "scenes";

std::vector<std::filesystem::path> scenesBelow(const std::filesystem::path& folder)
{
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb"))
            paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    return paths;
}

/// 7.7 million triangles by instancing: a minute's work, and instancing has a test of its own.
constexpr const char* kTooLarge = "materials/blender-io/24_gpu_instancing/24_gpu_instancing.gltf";

/// Files that must not compile, by path below shared/scenes; all others must.
const std::map<std::string, ExitCode> kRefused{
    {"compressed/chair-variants/chair-gltfpack-cz-khr.glb", ExitCode::kUnsupported},
    {"generator/Compatibility/Compatibility_04.gltf", ExitCode::kUnsupported},       // minVersion 2.1
    {"generator/Compatibility/Compatibility_05.gltf", ExitCode::kUnsupported},       // a made-up required extension
    {"generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_00.gltf", ExitCode::kInvalid}, // points and lines only
    {"generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_01.gltf", ExitCode::kInvalid},
    {"generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_02.gltf", ExitCode::kInvalid},
    {"generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_03.gltf", ExitCode::kInvalid},
    {"generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_07.gltf", ExitCode::kInvalid},
    {"generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_08.gltf", ExitCode::kInvalid},
    {"generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_09.gltf", ExitCode::kInvalid},
    {"generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_10.gltf", ExitCode::kInvalid},
};

class SharedScenes : public testing::TestWithParam<const char*>
{
protected:
    void SetUp() override
    {
        if (!std::filesystem::exists(kScenes))
            GTEST_SKIP() << "shared scenes not found";
    }
};

TEST_P(SharedScenes, CompileIntoValidPackagesOrAreRefusedAsDocumented)
{
    const TemporaryFolder folder;
    const std::vector<std::filesystem::path> scenes = scenesBelow(kScenes / GetParam());
    ASSERT_FALSE(scenes.empty());
    for (const std::filesystem::path& scene : scenes)
    {
        const std::string name = std::filesystem::relative(scene, kScenes).string();
        if (name == kTooLarge)
            continue;
        const auto refused = kRefused.find(name);
        const Result<CompileReport> report = compile({.input = scene, .output = folder / "out.lumi"});
        if (refused != kRefused.end())
        {
            ASSERT_FALSE(report) << name;
            EXPECT_EQ(report.error().code, refused->second) << name << ": " << report.error().message;
            continue;
        }
        ASSERT_TRUE(report) << name << ": " << report.error().message;
        const auto package = package::Package::open(folder / "out.lumi");
        EXPECT_TRUE(package) << name << ": " << package.error().message;
    }
}
INSTANTIATE_TEST_SUITE_P(Folders, SharedScenes,
                         testing::Values("materials", "generator", "scenes", "truth", "compressed", "anim"),
                         [](const auto& test) { return std::string(test.param); });

TEST(SharedScenesCompressed, EveryReadableChairHasTheSameSurface)
{
    const std::filesystem::path folder = kScenes / "compressed/chair-variants";
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "shared scenes not found";
    const TemporaryFolder out;
    std::vector<uint64_t> triangles;
    for (const char* name :
         {"chair.glb", "chair-draco.glb", "chair-meshopt.glb", "chair-quantized.glb", "chair-webp.glb"})
    {
        const Result<CompileReport> report = compile({.input = folder / name, .output = out / "chair.lumi"});
        ASSERT_TRUE(report) << name << ": " << report.error().message;
        const lumicut::fb::StatisticsT& s = *report->meta.statistics;
        triangles.push_back(s.triangles + s.degenerate_triangles + s.duplicate_triangles);
        const lumicut::fb::Vec3 size = *report->meta.bounds_max;
        EXPECT_GT(size.y(), 0.5f) << name; // a chair is most of a metre high
        EXPECT_LT(size.y(), 1.5f) << name;
    }
    for (const uint64_t count : triangles)
        EXPECT_EQ(count, triangles[0]);
}

TEST(SharedScenesNegative, EveryBrokenFileEndsWithADocumentedCodeAndOneLine)
{
    if (!std::filesystem::exists(kScenes / "negative"))
        GTEST_SKIP() << "shared scenes not found";
    const TemporaryFolder folder;
    for (const std::filesystem::path& scene : scenesBelow(kScenes / "negative"))
    {
        const Result<CompileReport> report = compile({.input = scene, .output = folder / "out.lumi"});
        if (report)
            continue;
        const Error& error = report.error();
        EXPECT_TRUE(error.code == ExitCode::kIo || error.code == ExitCode::kInvalid ||
                    error.code == ExitCode::kUnsupported)
            << scene << ": " << int(error.code) << " " << error.message;
        EXPECT_FALSE(error.message.empty()) << scene;
        EXPECT_EQ(error.message.find('\n'), std::string::npos) << scene;
    }
}
} // namespace
