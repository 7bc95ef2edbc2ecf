// Animations from file to package to pose.
#include "compiler/compile.h"
#include "tests/compiler/gltf_builder.h"
#include "tests/compiler/posed_package.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{
const std::filesystem::path kShared = LUMICUT_SHARED_DIR;

/// All scenes with animations, and those that show how joints place meshes.
std::vector<std::filesystem::path> sharedScenes()
{
    std::vector<std::filesystem::path> paths;
    for (const char* folder : {"scenes/anim", "scenes/generator", "cases"})
        if (std::filesystem::exists(kShared / folder))
            for (const auto& entry : std::filesystem::recursive_directory_iterator(kShared / folder))
            {
                const std::string path = entry.path().string();
                const bool wanted = path.find("/anim/") != std::string::npos ||
                                    path.find("/Animation_") != std::string::npos ||
                                    path.find("/08-") != std::string::npos;
                if (wanted && (path.ends_with(".gltf") || path.ends_with(".glb")))
                    paths.push_back(entry.path());
            }
    std::sort(paths.begin(), paths.end());
    return paths;
}

double sizeOf(const package::Package& package)
{
    const lumicut::fb::Vec3 &low = *package.meta().bounds_min(), &high = *package.meta().bounds_max();
    return length(Vec3d{high.x(), high.y(), high.z()} - Vec3d{low.x(), low.y(), low.z()});
}

Result<package::Package> compiled(CompileOptions options, const TemporaryFolder& folder)
{
    options.output = folder / "out.lumi";
    options.textures = TextureCompression::kRaw;
    options.default_light = DefaultLight::kOff;
    const Result<CompileReport> report = compile(options);
    if (!report)
        return report.error();
    return package::Package::open(options.output);
}

TEST(MotionOfSharedScenes, PoseAtRestIsThePackagesOwn)
{
    const std::vector<std::filesystem::path> scenes = sharedScenes();
    if (scenes.empty())
        GTEST_SKIP() << "shared scenes not found";
    size_t moving = 0;
    for (const std::filesystem::path& scene : scenes)
    {
        const TemporaryFolder folder;
        const auto package = compiled({.input = scene, .output = {}}, folder);
        ASSERT_TRUE(package) << scene << ": " << package.error().message;
        if (package->motion() == nullptr)
        {
            EXPECT_EQ(package->firstMovingTriangle(), package->triangles().size()) << scene;
            continue;
        }
        ++moving;
        const std::vector<Vec3d> moved = movedVertices(*package, package::poseAtRest(*package));
        const std::vector<Vec3d> rest = restVertices(*package);
        ASSERT_EQ(moved.size() + package->firstMovingVertex(), rest.size()) << scene;
        // Bones are rounded to floats, as positions are: each of the four products by 2^-24 of itself.
        const double most = sizeOf(*package) * 1e-6;
        for (size_t i = 0; i < moved.size(); ++i)
            ASSERT_LT(length(moved[i] - rest[package->firstMovingVertex() + i]), most) << scene << " vertex " << i;
    }
    EXPECT_GE(moving, 20u);
}
/// All triangles of a package in a pose, in metres.
std::vector<Corners> posed(const package::Package& package, const package::Pose& pose)
{
    std::vector<Vec3d> positions = restVertices(package);
    const std::vector<Vec3d> moved = movedVertices(package, pose);
    std::copy(moved.begin(), moved.end(), positions.begin() + package.firstMovingVertex());
    return trianglesOver(package, positions);
}

TEST(MotionOfSharedScenes, PosesAreThoseOfTheSameFilesCompiledAtThatTime)
{
    const std::vector<std::filesystem::path> scenes = sharedScenes();
    if (scenes.empty())
        GTEST_SKIP() << "shared scenes not found";
    for (const std::filesystem::path& scene : scenes)
    {
        const TemporaryFolder folder;
        const auto package = compiled({.input = scene, .output = {}}, folder);
        ASSERT_TRUE(package) << scene << ": " << package.error().message;
        for (uint32_t clip = 0; package->motion() != nullptr && clip < package->motion()->clips()->size(); ++clip)
            for (int i = 0; i < (clip == 0 ? 10 : 3); ++i)
            {
                const double seconds = package->motion()->clips()->Get(clip)->duration() * (i + 0.37) / 9;
                const auto baked =
                    compiled({.input = scene, .output = {}, .time = BakedTime{seconds, std::to_string(clip)}}, folder);
                ASSERT_TRUE(baked) << scene << ": " << baked.error().message;
                ASSERT_EQ(baked->motion(), nullptr);
                const double apart = farthestCorner(posed(*package, package::poseAt(*package, clip, seconds)),
                                                    trianglesOver(*baked, restVertices(*baked)));
                EXPECT_LT(apart, 1e-4 * sizeOf(*package)) << scene << " clip " << clip << " at " << seconds << " s";
            }
    }
}
} // namespace
