// lumicut-pkg as its users meet it: exit codes, stdout for results, stderr for complaints, bundles that repeat.
#include "format/check.h"
#include "tests/format/sample_package.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <cstring>
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
    EXPECT_EQ(json["chunks"].size(), 16u);
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

TEST_F(PkgCommand, DiffIsSilentWhereNothingDiffersAndNamesWhatDoes)
{
    EXPECT_EQ(run("diff good.lumi good.lumi"), 0);
    EXPECT_EQ(out + err, "");
    SamplePackage sample;
    sample.meta.provenance->options.push_back("--sun 1");
    sample.vertices[0].uv0.x += 0.25f;
    ASSERT_TRUE(sample.write(folder.path() / "other.lumi"));
    EXPECT_EQ(run("diff good.lumi other.lumi"), 1);
    EXPECT_NE(out.find("+option --sun 1\n"), std::string::npos) << out;
    EXPECT_NE(out.find("chunk VATT 0"), std::string::npos) << out;
    EXPECT_EQ(out.find("chunk NODE 0"), std::string::npos) << out;
    ASSERT_EQ(run("diff good.lumi other.lumi --format json"), 1);
    const nlohmann::json json = nlohmann::json::parse(out);
    std::set<std::string> differing;
    for (const auto& chunk : json["chunks"])
        if (!chunk["same"].get<bool>())
            differing.insert(chunk["id"]);
    EXPECT_EQ(differing, (std::set<std::string>{"META", "VATT"}));
    for (const char* trouble : {"diff good.lumi bad.lumi", "diff good.lumi none.lumi", "diff good.lumi", "diff"})
        EXPECT_EQ(run(trouble), 2) << trouble;
}

TEST_F(PkgCommand, ExtractWritesThingsAsOtherProgramsReadThem)
{
    const auto package = package::Package::open(folder.path() / "good.lumi");
    ASSERT_TRUE(package);
    ASSERT_EQ(run("extract good.lumi geometry -o g.glb"), 0) << err;
    const std::string glb = readText(folder.path() / "g.glb");
    ASSERT_EQ(glb.substr(0, 4), "glTF");
    uint32_t json_bytes = 0;
    std::memcpy(&json_bytes, glb.data() + 12, 4);
    const nlohmann::json json = nlohmann::json::parse(glb.substr(20, json_bytes));
    size_t corners = 0;
    for (const auto& primitive : json["meshes"][0]["primitives"])
        corners += json["accessors"][size_t(primitive["indices"])]["count"].get<size_t>();
    EXPECT_EQ(corners, 3 * package->triangles().size());
    EXPECT_EQ(json["accessors"][0]["count"], package->vertexAttributes().size());
    EXPECT_EQ(json["materials"].size(), package->materials().size());

    ASSERT_EQ(run("extract good.lumi VATT -o v.bin"), 0) << err;
    EXPECT_EQ(std::filesystem::file_size(folder.path() / "v.bin"),
              package->vertexAttributes().size() * sizeof(package::StoredVertex));
    ASSERT_EQ(run("extract good.lumi texture/0/0 -o t.png"), 0) << err;
    EXPECT_EQ(readText(folder.path() / "t.png").substr(1, 3), "PNG");
    ASSERT_EQ(run("extract good.lumi environment -o e.exr"), 0) << err;
    EXPECT_EQ(readText(folder.path() / "e.exr").substr(0, 4), "\x76\x2f\x31\x01");
}

TEST_F(PkgCommand, ExtractRefusesWhatIsNotThereAndLeavesNothing)
{
    for (const char* wrong : {"geometry -o x.obj", "texture/99/0 -o x.png", "texture/0 -o x.png", "NONE -o x.bin",
                              "VATT/1 -o x.bin", "TEXP/a -o x.bin", "TEXP/0/0/0 -o x.bin"})
        EXPECT_EQ(run(std::string("extract good.lumi ") + wrong), 1) << wrong;
    EXPECT_EQ(run("extract bad.lumi geometry -o x.glb"), 3);
    EXPECT_EQ(run("extract good.lumi geometry -o none/x.glb"), 2);
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        EXPECT_FALSE(entry.path().filename().string().starts_with("x")) << entry.path();
}
