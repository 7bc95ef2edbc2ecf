// lumicut-pkg as its users meet it: exit codes, stdout for results, stderr for complaints, bundles that repeat.
#include "format/check.h"
#include "tests/format/sample_package.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>

namespace
{
std::string readText(const std::filesystem::path& path)
{
    const std::vector<std::byte> bytes = readFile(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

struct PkgCommand : testing::Test
{
    TemporaryFolder folder;
    std::string out;
    std::string err;

    PkgCommand()
    {
        check(SamplePackage().write(folder.path() / "good.lumi"), "sample");
        std::ofstream(folder.path() / "bad.lumi") << "bad";
    }

    /// Runs `lumicut-pkg arguments` in the folder. @return its exit code
    int run(const std::string& arguments)
    {
        const std::string command =
            "cd '" + folder.path().string() + "' && '" LUMICUT_PKG "' " + arguments + " >out 2>err";
        const int status = std::system(command.c_str());
        out = readText(folder.path() / "out");
        err = readText(folder.path() / "err");
        return WEXITSTATUS(status);
    }
};
} // namespace

TEST_F(PkgCommand, ValidateIsSilentWhereAllIsWell)
{
    EXPECT_EQ(run("validate good.lumi good.lumi"), 0);
    EXPECT_EQ(out + err, "");
}

TEST_F(PkgCommand, ValidateNamesTheBadFile)
{
    EXPECT_EQ(run("validate good.lumi bad.lumi"), 3);
    EXPECT_EQ(out, "");
    EXPECT_TRUE(err.starts_with("bad.lumi: error: ")) << err;
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
    EXPECT_EQ(run("validate none.lumi"), 2);
    EXPECT_EQ(run("validate"), 1);
}

TEST_F(PkgCommand, InfoPrintsJson)
{
    ASSERT_EQ(run("info good.lumi --format json"), 0);
    const nlohmann::json json = nlohmann::json::parse(out);
    EXPECT_EQ(json["triangles"], 5);
    EXPECT_EQ(json["lights"]["triangle"], 1);
    EXPECT_EQ(json["cameras"][0]["name"], "front");
    EXPECT_EQ(json["chunks"].size(), 13u);
    EXPECT_EQ(json["file_bytes"], std::filesystem::file_size(folder.path() / "good.lumi"));
}

TEST_F(PkgCommand, InfoTellsWhereThePackageLiesInItsSource)
{
    SamplePackage sample;
    sample.meta.origin = std::make_unique<lumicut::fb::Vec3d>(2600000.25, 400.0, -1200000.5);
    sample.meta.unit = 0.25;
    ASSERT_TRUE(sample.write(folder.path() / "far.lumi"));
    ASSERT_EQ(run("info far.lumi --format json"), 0);
    const nlohmann::json json = nlohmann::json::parse(out);
    EXPECT_EQ(json["origin"], nlohmann::json({2600000.25, 400.0, -1200000.5}));
    EXPECT_EQ(json["unit"], 0.25);
    ASSERT_EQ(run("info far.lumi"), 0);
    EXPECT_NE(out.find("(2600000.25, 400, -1200000.5) m in the source, unit 0.25 m"), std::string::npos) << out;
    ASSERT_EQ(run("info good.lumi --format json"), 0);
    EXPECT_EQ(nlohmann::json::parse(out)["origin"], nlohmann::json({0, 0, 0}));
    EXPECT_EQ(nlohmann::json::parse(out)["unit"], 1);
}

TEST_F(PkgCommand, InfoPrintsNoEscapesOfTheFile)
{
    SamplePackage sample;
    sample.meta.cameras[0]->name = "a\x1b[31mb";
    ASSERT_TRUE(sample.write(folder.path() / "odd.lumi"));
    ASSERT_EQ(run("info odd.lumi"), 0);
    EXPECT_EQ(out.find('\x1b'), std::string::npos);
    EXPECT_NE(out.find("a?[31mb"), std::string::npos) << out;
}

TEST_F(PkgCommand, BundleRepeatsByteForByte)
{
    // Any program with shared libraries will do as player here.
    ASSERT_EQ(run("bundle good.lumi -o demo.tar.zst --player '" LUMICUT_PKG "'"), 0) << err;
    const auto first = readFile(folder.path() / "demo.tar.zst");
    ASSERT_EQ(run("bundle good.lumi -o demo.tar.zst --player '" LUMICUT_PKG "'"), 0) << err;
    EXPECT_EQ(first, readFile(folder.path() / "demo.tar.zst"));

    ASSERT_EQ(std::system(("tar --zstd -xf '" + (folder.path() / "demo.tar.zst").string() + "' -C '" +
                           folder.path().string() + "'")
                              .c_str()),
              0);
    const nlohmann::json manifest = nlohmann::json::parse(readText(folder.path() / "demo/manifest.json"));
    std::set<std::string> files;
    for (const auto& file : manifest["files"])
    {
        files.insert(file["path"]);
        EXPECT_EQ(file["bytes"], std::filesystem::file_size(folder.path() / "demo" / std::string(file["path"])));
    }
    for (const char* wanted : {"bin/lumicut-play", "packages/good.lumi", "run.sh", "README.txt", "LICENSES/scenes.txt"})
        EXPECT_TRUE(files.contains(wanted)) << wanted;
    EXPECT_FALSE(files.contains("lib/libc.so.6"));
    EXPECT_NE(readText(folder.path() / "demo/LICENSES/scenes.txt").find("CC0"), std::string::npos);
}

TEST_F(PkgCommand, BundleRefusesWhatCannotWorkAndLeavesNothing)
{
    EXPECT_EQ(run("bundle good.lumi -o demo.zip"), 1);
    EXPECT_EQ(run("bundle bad.lumi -o demo.tar.zst --player '" LUMICUT_PKG "'"), 3);
    EXPECT_EQ(run("bundle good.lumi -o demo.tar.zst --player none"), 2);
    EXPECT_EQ(run("bundle good.lumi -o none/demo.tar.zst --player '" LUMICUT_PKG "'"), 2);
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        EXPECT_EQ(entry.path().filename().string().find("demo"), std::string::npos) << entry.path();
}
