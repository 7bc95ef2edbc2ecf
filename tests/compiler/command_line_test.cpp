#include "compiler/camera_views.h"
#include "format/package_read.h"
#include "tests/compiler/gltf_builder.h"
#include "tests/compiler/program_run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numbers>

namespace
{
class CommandLine : public testing::Test
{
protected:
    CommandLine()
    {
        GltfBuilder builder;
        builder.triangle();
        builder.writeGltf(folder_ / "scene.gltf");
    }
    std::string path(const char* name) const { return fmt::format("'{}'", (folder_ / name).string()); }
    std::string scene() const { return path("scene.gltf"); }

    TemporaryFolder folder_;
};

TEST_F(CommandLine, CompilesBesideTheInputByDefault)
{
    const ProgramRun r =
        runCompiler(scene() + " --sun 0,-1,0,100 --view a=0,0,3,0,0,0,40 --compress zstd:1 --report " + path("r.json"));
    EXPECT_EQ(r.code, 0) << r.output;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "scene.lumi"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "r.json"));
    EXPECT_NE(r.output.find("1 directional"), std::string::npos) << r.output;
    EXPECT_EQ(r.output.find('\x1b'), std::string::npos);
}

TEST_F(CommandLine, ListPrintsWhatTheFileOffersAndCompilesNothing)
{
    const ProgramRun text = runCompiler("--list " + scene());
    EXPECT_EQ(text.code, 0) << text.output;
    EXPECT_TRUE(text.output.starts_with("scenes     1\n")) << text.output;
    const ProgramRun json = runCompiler("--list --json " + scene());
    EXPECT_EQ(json.code, 0) << json.output;
    EXPECT_TRUE(json.output.starts_with("{")) << json.output;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "scene.lumi"));
    EXPECT_EQ(runCompiler("--json " + scene()).code, 1);
    EXPECT_EQ(runCompiler("--list " + path("gone.gltf")).code, 2);
    EXPECT_EQ(runCompiler(scene() + " --variant blue").code, 1);
    EXPECT_EQ(runCompiler(scene() + " --scene 1").code, 1);
    EXPECT_EQ(runCompiler(scene() + " --scene 0").code, 0);
}

TEST_F(CommandLine, QuietPrintsNothing)
{
    const ProgramRun r = runCompiler(scene() + " -q");
    EXPECT_EQ(r.code, 0);
    EXPECT_EQ(r.output, "");
}

TEST_F(CommandLine, EnvironmentOptionsAreRecordedAndItsErrorsNameIt)
{
    const std::string pixels(4 * 8, char(130));
    std::ofstream(folder_ / "sky.hdr", std::ios::binary) << "#?RADIANCE\n\n-Y 2 +X 4\n" << pixels;
    const ProgramRun made = runCompiler(scene() + " --env " + path("sky.hdr") + " --env-rotate -450 --env-scale 0.5");
    ASSERT_EQ(made.code, 0) << made.output;
    const auto package = package::Package::open(folder_ / "scene.lumi");
    ASSERT_TRUE(package) << package.error().message;
    EXPECT_FLOAT_EQ(package->meta().environment()->rotation(), -float(std::numbers::pi) / 2);
    EXPECT_EQ(package->environmentMap()[3].y, 0.5f * 130 / 64); // 130 x 2^(130 - 136)
    std::vector<std::string> options;
    for (const auto* option : *package->meta().provenance()->options())
        options.push_back(option->str());
    EXPECT_EQ(options, (std::vector<std::string>{"--env sky.hdr", "--env-rotate -450", "--env-scale 0.5"}));

    std::ofstream(folder_ / "cut.hdr", std::ios::binary) << "#?RADIANCE\n\n-Y 2 +X 4\n" << pixels.substr(1);
    const ProgramRun refused = runCompiler(scene() + " --env " + path("cut.hdr"));
    EXPECT_EQ(refused.code, 3);
    EXPECT_TRUE(refused.output.find("cut.hdr: error: the HDR image is damaged in line 2 of 2") != std::string::npos)
        << refused.output;
}

TEST_F(CommandLine, VersionAndHelpSucceed)
{
    EXPECT_EQ(runCompiler("--version").output, "lumicut-compile " LUMICUT_VERSION "\n");
    EXPECT_EQ(runCompiler("--help").code, 0);
}

TEST_F(CommandLine, MistakesInArgumentsAreUsageErrors)
{
    const std::vector<std::string> mistakes{"",
                                            "--nonsense",
                                            scene() + " -o out.txt",
                                            scene() + " --sun 1,2,3",
                                            scene() + " --sun 0,0,0,1",
                                            scene() + " --sun 1,2,3,x",
                                            scene() + " --env-rotate 90",
                                            scene() + " --env sky.exr --env-rotate north",
                                            scene() + " --env sky.exr --env-rotate 1e999",
                                            scene() + " --env sky.exr --env-scale 0",
                                            scene() + " --env sky.exr --env-scale -1",
                                            scene() + " --view a=1,2",
                                            scene() + " --view a=0,0,0,0,0,0,40",
                                            scene() + " --view a=0,0,1,0,0,0,180",
                                            scene() + " --compress zip",
                                            scene() + " --compress zstd:99",
                                            scene() + " --env sky.png",
                                            "scene.obj"};
    for (const std::string& arguments : mistakes)
        EXPECT_EQ(runCompiler(arguments).code, 1) << arguments;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "scene.lumi"));
}

TEST_F(CommandLine, FilesThatCannotBeReadOrWrittenAreInputOutputErrors)
{
    std::filesystem::create_directory(folder_ / "folder.gltf");
    for (const std::string& arguments :
         {path("gone.gltf"), path("folder.gltf"), scene() + " -o " + path("none/out.lumi"),
          scene() + " --env " + path("gone.exr")})
    {
        const ProgramRun r = runCompiler(arguments);
        EXPECT_EQ(r.code, 2) << arguments << "\n" << r.output;
        EXPECT_NE(r.output.find(": error: "), std::string::npos) << r.output;
    }
}

TEST_F(CommandLine, AnEmptyFileAndAGlbCutInHalfAreInvalid)
{
    GltfBuilder builder;
    builder.triangle();
    builder.writeGlb(folder_ / "whole.glb");
    std::filesystem::copy_file(folder_ / "whole.glb", folder_ / "half.glb");
    std::filesystem::resize_file(folder_ / "half.glb", std::filesystem::file_size(folder_ / "whole.glb") / 2);
    writeBytes(folder_ / "empty.glb", "", 0);
    for (const char* name : {"half.glb", "empty.glb"})
    {
        const ProgramRun r = runCompiler(path(name) + " -q");
        EXPECT_EQ(r.code, 3) << name;
        EXPECT_EQ(std::count(r.output.begin(), r.output.end(), '\n'), 1) << r.output;
    }
}

TEST(CameraViews, AViewLooksFromTheEyeToTheTarget)
{
    const Result<CameraView> view = parseView("hall=1,2,3,1,2,-7,90");
    ASSERT_TRUE(view) << view.error().message;
    EXPECT_EQ(view->name, "hall");
    EXPECT_EQ(view->position.z, 3);
    EXPECT_FLOAT_EQ(view->forward.z, -1);
    EXPECT_FLOAT_EQ(view->up.y, 1);
    EXPECT_NEAR(view->vertical_fov, 1.5707963, 1e-6);
}

TEST(CameraViews, MapCoordinatesKeepTheirCentimetres)
{
    const Result<CameraView> view = parseView("site=448251.71,35.2,-5411943.33,448251.71,35.2,-5411943.34,40");
    ASSERT_TRUE(view) << view.error().message;
    EXPECT_EQ(view->position, (Vec3d{448251.71, 35.2, -5411943.33}));
    EXPECT_FLOAT_EQ(view->forward.z, -1);
}

TEST(CameraViews, LookingStraightDownStillHasAnUpVector)
{
    const Result<CameraView> view = parseView("plan=0,5,0,0,0,0,60");
    ASSERT_TRUE(view) << view.error().message;
    EXPECT_FLOAT_EQ(view->forward.y, -1);
    EXPECT_FLOAT_EQ(view->up.z, -1);
}
} // namespace
