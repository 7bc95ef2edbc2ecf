// Several scenes in one call, and packages that are up to date: lumicut-compile as build systems call it.
#include "compiler/dependency_file.h"
#include "tests/compiler/gltf_builder.h"
#include "tests/compiler/program_run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

namespace
{
namespace fs = std::filesystem;

class Many : public testing::Test
{
protected:
    Many()
    {
        GltfBuilder builder;
        builder.triangle();
        for (const char* name : {"a.glb", "b.glb", "c.glb"})
            builder.writeGlb(folder_ / name);
        writeBytes(folder_ / "bad.glb", "{", 1);
        fs::current_path(folder_.path());
    }
    ~Many() override { fs::current_path("/"); }

    static std::string text(const fs::path& path)
    {
        std::ifstream stream(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    /// A scene that names a texture beside it.
    static void writeTextured(const char* name, uint8_t red)
    {
        const std::vector<unsigned char> png = encodePng(1, 1, {red, 0, 0, 255});
        writeBytes("paint #1.png", png.data(), png.size());
        GltfBuilder builder;
        builder.json["images"] = {{{"uri", "paint%20%231.png"}}};
        builder.json["textures"] = {{{"source", 0}}};
        builder.material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
        builder.triangle({{"material", 0}});
        builder.writeGltf(name);
    }

    TemporaryFolder folder_;
};

TEST_F(Many, TheRestIsCompiledAndTheFirstFailureDecides)
{
    const ProgramRun r = runCompiler("a.glb gone.glb bad.glb b.glb -o out/ --report reports/ -j 2");
    EXPECT_EQ(r.code, 2) << r.output;
    EXPECT_NE(r.output.find("gone.glb: error: "), std::string::npos) << r.output;
    EXPECT_NE(r.output.find("bad.glb: error: "), std::string::npos) << r.output;
    for (const char* name : {"out/a.lumi", "out/b.lumi", "reports/a.json", "reports/b.json"})
        EXPECT_TRUE(fs::exists(name)) << name;
    EXPECT_EQ(std::distance(fs::directory_iterator("out"), {}), 2);
    EXPECT_EQ(runCompiler("bad.glb gone.glb").code, 3);
}

TEST_F(Many, EachGoesBesideItsSceneByDefaultAndNoTwoIntoOneFile)
{
    EXPECT_EQ(runCompiler("a.glb b.glb -q").code, 0);
    EXPECT_TRUE(fs::exists("a.lumi") && fs::exists("b.lumi"));
    fs::create_directory("d");
    fs::copy_file("a.glb", "d/a.glb");
    const ProgramRun r = runCompiler("a.glb d/a.glb -o out/");
    EXPECT_EQ(r.code, 1);
    EXPECT_NE(r.output.find("the same file"), std::string::npos) << r.output;
    EXPECT_EQ(runCompiler("a.glb b.glb -o one.lumi").code, 1);
    EXPECT_EQ(runCompiler("a.glb b.glb -o a.glb").code, 1);
}

TEST_F(Many, WhatIsUpToDateIsLeftAlone)
{
    writeTextured("t.gltf", 10);
    const auto compiled = [](const std::string& arguments)
    {
        const ProgramRun r = runCompiler("t.gltf " + arguments);
        EXPECT_EQ(r.code, 0) << r.output;
        return r.output != "t.lumi: up to date\n";
    };
    EXPECT_TRUE(compiled(""));
    const auto old = fs::last_write_time("t.lumi") - std::chrono::hours(1);
    fs::last_write_time("t.lumi", old);
    EXPECT_FALSE(compiled(""));
    EXPECT_EQ(fs::last_write_time("t.lumi"), old);
    EXPECT_FALSE(compiled("--jobs 1 --cache c")); // change nothing in the package
    EXPECT_TRUE(compiled("--force"));
    EXPECT_TRUE(compiled("--sun 0,-1,0,100"));
    EXPECT_FALSE(compiled("--sun 0,-1,0,100"));
    EXPECT_TRUE(compiled("--sun 0,-1,0,100 --report r.json")); // there was no report
    EXPECT_FALSE(compiled("--sun 0,-1,0,100 --report r.json"));
    EXPECT_TRUE(compiled("--report r.json"));
    writeTextured("t.gltf", 11); // another texture, the same scene
    EXPECT_TRUE(compiled(""));
    EXPECT_FALSE(compiled(""));
    std::string damaged = text("t.lumi");
    damaged.back() = char(damaged.back() ^ 1);
    writeBytes("t.lumi", damaged.data(), damaged.size());
    EXPECT_TRUE(compiled(""));
}

TEST_F(Many, MakeIsToldAllFilesAndIsContentAfterwards)
{
    writeTextured("t.gltf", 10);
    std::ofstream("Makefile") << "t.lumi: t.gltf\n\t'" LUMICUT_COMPILE_PROGRAM "' -q t.gltf --deps t.d\n-include t.d\n";
    std::ofstream("build.ninja") << "rule lumi\n  command = '" LUMICUT_COMPILE_PROGRAM
                                    "' -q t.gltf --deps t.d\n  depfile = t.d\nbuild t.lumi: lumi t.gltf\n";
    ASSERT_EQ(std::system("ninja >out 2>&1"), 0) << text("out");
    EXPECT_EQ(text("t.d"), "t.lumi: \\\n  t.gltf \\\n  paint\\ \\#1.png\n\nt.gltf:\n\npaint\\ \\#1.png:\n");
    const auto rebuilds = [&](const char* what)
    {
        EXPECT_EQ(std::system(fmt::format("{} >out 2>&1", what).c_str()), 0) << text("out");
        const std::string said = text("out");
        return said.find("up to date") == std::string::npos && said.find("no work to do") == std::string::npos;
    };
    EXPECT_FALSE(rebuilds("ninja"));
    // A later time, the same content: called once, then content, though the package keeps its bytes.
    fs::last_write_time("paint #1.png", fs::file_time_type::clock::now() + std::chrono::milliseconds(20));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_TRUE(rebuilds("ninja"));
    EXPECT_FALSE(rebuilds("ninja"));
    if (std::system("command -v make >/dev/null") != 0)
        GTEST_SKIP() << "make is not installed; ninja was asked";
    EXPECT_FALSE(rebuilds("make"));
    writeTextured("t.gltf", 99);
    EXPECT_TRUE(rebuilds("make"));
    EXPECT_FALSE(rebuilds("make"));
}

TEST(DependencyFile, NamesAreEscapedForMake)
{
    const Result<std::string> rule = dependencyRule("out dir/a$.lumi", {"x y.glb", "tail\\ z", "c#.bin"});
    ASSERT_TRUE(rule);
    EXPECT_EQ(rule->substr(0, rule->find("\n\n")),
              "out\\ dir/a$$.lumi: \\\n  x\\ y.glb \\\n  tail\\\\\\ z \\\n  c\\#.bin");
    EXPECT_FALSE(dependencyRule("a.lumi", {"two\nlines"}));
}
} // namespace
