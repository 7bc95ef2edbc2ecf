// lumicut-play as a program: error messages, files that it writes, pictures.
#include "image/read_exr.h"
#include "tests/tools/run_program.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <set>

namespace
{
/// A grey floor under a lamp, with a pane of thin glass between them and a mirror behind.
constexpr const char* kScene = R"({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3, 4]}],
    "nodes": [{"mesh": 0}, {"mesh": 1, "translation": [0, 2, 0], "rotation": [1, 0, 0, 0]},
              {"mesh": 2, "translation": [0, 1, 0], "scale": [0.5, 0.5, 0.5]},
              {"mesh": 3, "translation": [0, 1, -2], "rotation": [0.70710678, 0, 0, 0.70710678]},
              {"camera": 0, "name": "eye", "translation": [0, 1, 4]}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
    "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}},
                  {"emissiveFactor": [1, 1, 1]},
                  {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
                   "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}},
                  {"pbrMetallicRoughness": {"roughnessFactor": 0}}],
    "extensionsUsed": ["KHR_materials_transmission"],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]},
               {"primitives": [{"attributes": {"POSITION": 0}, "material": 1}]},
               {"primitives": [{"attributes": {"POSITION": 0}, "material": 2}]},
               {"primitives": [{"attributes": {"POSITION": 0}, "material": 3}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 6, "min": [-1, 0, -1], "max": [1, 0, 1]}],
    "bufferViews": [{"buffer": 0, "byteLength": 72}],
    "buffers": [{"uri": "square.bin", "byteLength": 72}]})";
constexpr std::array<float, 18> kSquare{-1, 0, -1, -1, 0, 1, 1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0, -1}; // faces +Y

void writeFile(const std::filesystem::path& path, const std::string& bytes)
{
    std::ofstream(path, std::ios::binary) << bytes;
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// A folder with the scene above, compiled. Where any picture will do it is of mode direct: a software device takes most of a run for
/// the kernels of mode gi.
class Player : public testing::Test
{
protected:
    void SetUp() override
    {
        ::setenv("XDG_CACHE_HOME", LUMICUT_TEST_CACHE, 1); // pipelines are built once for all tests
        writeFile(folder_ / "scene.gltf", kScene);
        writeFile(folder_ / "square.bin", {reinterpret_cast<const char*>(kSquare.data()), sizeof(kSquare)});
        const ProgramRun run = compile(path("scene.gltf"));
        ASSERT_EQ(run.exit_code, 0) << run.err;
    }

    std::string path(const std::string& name) const { return fmt::format("'{}'", (folder_ / name).string()); }
    ProgramRun play(const std::string& arguments) const
    {
        return runProgram(LUMICUT_PLAY,
                          arguments + " --headless" + (contains(arguments, "--size") ? "" : " --size 32x24"));
    }
    ProgramRun compile(const std::string& arguments) const { return runProgram(LUMICUT_COMPILE, arguments); }

    std::string render(const std::string& name, const std::string& arguments) const
    {
        const ProgramRun run = play(path("scene.lumi") + " " + arguments + " --output " + path(name));
        EXPECT_EQ(run.exit_code, 0) << arguments << "\n" << run.err;
        EXPECT_EQ(run.out, "") << arguments;
        return fileBytes(folder_ / name);
    }

    /// Without what the file says of them.
    std::vector<float> pixels(const std::string& name) const
    {
        const auto image = readExr(folder_ / name);
        EXPECT_TRUE(image) << name;
        return image ? image->rgb : std::vector<float>();
    }

    std::set<std::string> files() const
    {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path()))
            names.insert(entry.path().lexically_relative(folder_.path()).string());
        return names;
    }

    /// A run that must fail: with this code, a sentence on stderr that holds `words`, nothing on stdout, no file more.
    void expectRefusal(const ProgramRun& run, const std::set<std::string>& before, int code,
                       const std::string& words) const
    {
        EXPECT_EQ(run.exit_code, code) << run.err;
        EXPECT_TRUE(contains(run.err, words)) << run.err;
        EXPECT_EQ(run.out, "");
        EXPECT_EQ(files(), before) << run.err;
        EXPECT_FALSE(contains(run.err, "\x1b")) << run.err; // no escapes into a pipe
    }

    void expectPlayRefused(const std::string& arguments, int code, const std::string& words) const
    {
        SCOPED_TRACE(arguments);
        const std::set<std::string> before = files();
        expectRefusal(play(arguments), before, code, words);
    }

    /// The same, where the sentence is the whole of stderr and begins with the package's path.
    void expectPackageRefused(const std::string& name, int code, const std::string& words) const
    {
        SCOPED_TRACE(name);
        const std::set<std::string> before = files();
        const ProgramRun run = play(path(name) + " --output " + path("out.exr"));
        expectRefusal(run, before, code, words);
        EXPECT_TRUE(run.err.starts_with((folder_ / name).string() + ": error: ")) << run.err;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    }

    TemporaryFolder folder_;
};

TEST_F(Player, RefusesFilesThatAreNoPackage)
{
    writeFile(folder_ / "empty.lumi", "");
    writeFile(folder_ / "text.lumi", "not a package at all\n");
    writeFile(folder_ / "scene.glb", std::string("glTF\2\0\0\0\x14\0\0\0", 12));
    std::filesystem::create_directory(folder_ / "folder.lumi");
    expectPackageRefused("empty.lumi", 3, "");
    expectPackageRefused("text.lumi", 3, "not a Lumicut package");
    expectPackageRefused("scene.glb", 3, "lumicut-compile");
    expectPackageRefused("scene.gltf", 3, "lumicut-compile");
    expectPackageRefused("folder.lumi", 2, "folder");
    expectPackageRefused("gone.lumi", 2, "");
}

TEST_F(Player, RefusesATruncatedPackage)
{
    const std::string whole = fileBytes(folder_ / "scene.lumi");
    for (const size_t length : {size_t(1), size_t(40), whole.size() / 2, whole.size() - 1})
    {
        writeFile(folder_ / "cut.lumi", whole.substr(0, length));
        expectPackageRefused("cut.lumi", 3, "truncated");
    }
}

TEST_F(Player, RefusesAFlippedBitAnywhere)
{
    const std::string whole = fileBytes(folder_ / "scene.lumi");
    constexpr size_t kFlips = 24;
    for (size_t i = 0; i < kFlips; ++i)
    {
        const size_t at = i * (whole.size() - 1) / (kFlips - 1); // the first and the last byte included
        std::string flipped = whole;
        flipped[at] = char(flipped[at] ^ (1 << i % 8));
        writeFile(folder_ / "flipped.lumi", flipped);
        expectPackageRefused("flipped.lumi", 3, "");
    }
}

TEST_F(Player, RefusesArgumentsThatMakeNoSense)
{
    const std::string scene = path("scene.lumi") + " ";
    const std::string output = " --output " + path("out.exr");
    expectPlayRefused("", 1, "a package is needed");
    expectPlayRefused("--frames 0 " + scene, 1, "lumicut-play: error: --frames: ");
    expectPlayRefused(scene + "--nonsense" + output, 1, "--nonsense");
    expectPlayRefused(scene + "--mode fast" + output, 1, "--mode");
    for (const std::string size : {"640", "0x10", "10x", "-4x4", "9000x10", "4x4x4", "axb"})
        expectPlayRefused(scene + "--size=" + size + output, 1, "WIDTHxHEIGHT");
    expectPlayRefused(scene + "--frames 2 --spp 2" + output, 1, "give one");
    for (const std::string count : {"--frames 0", "--frames -1", "--spp 0", "--spp x", "--seed -1"})
        expectPlayRefused(scene + count + output, 1, count.substr(0, count.find(' ')));
    for (const std::string setting : {"nonsense=1", "exposure", "exposure=bright", "direct_samples=0", "tonemap=film"})
        expectPlayRefused(scene + "--set " + setting + output, 1, "--set " + setting);
    expectPlayRefused(scene + "--mode gi --view nothing" + output, 1, "none,normals,");
    for (const std::string view : {"--view samples", "--set view=samples"})
        expectPlayRefused(scene + "--mode direct " + view + output, 1, "--mode gi");
    expectPlayRefused(scene + "--view error" + output, 1, "--against FILE.exr");
    expectPlayRefused(scene + "--against " + path("none.exr") + output, 1, "--view error");
    expectPlayRefused(scene + "--view error --against " + path("none.exr") + output, 2, "none.exr");
    expectPlayRefused(scene + "--view error --against " + path("scene.lumi") + output, 3, "scene.lumi");
    expectPlayRefused(scene + "--camera nowhere" + output, 1, "eye (0)");
    expectPlayRefused(scene + "--camera 1" + output, 1, "eye (0)");
    expectPlayRefused(scene + "--output " + path("out.jpg"), 1, ".exr or .png");
}

/// Where there is no driver, so that what is refused at once differs from what a device would be needed for.
TEST_F(Player, RefusesOutputsThatCannotBeWrittenBeforeItOpensADevice)
{
    std::filesystem::create_directory(folder_ / "folder.exr");
    std::filesystem::create_directory(folder_ / "frame-3.exr");
    writeFile(folder_ / "here.exr", "what was there");
    const auto expectRefused = [&](const std::string& arguments, int code, const std::string& words)
    {
        SCOPED_TRACE(arguments);
        const std::set<std::string> before = files();
        const std::string driverless = fmt::format("VK_ICD_FILENAMES=/none VK_DRIVER_FILES=/none '{}' --headless {} {}",
                                                   LUMICUT_PLAY, path("scene.lumi"), arguments);
        expectRefusal(runProgram("/usr/bin/env", driverless), before, code, words);
        EXPECT_EQ(fileBytes(folder_ / "here.exr"), "what was there");
    };
    expectRefused("--output " + path("none/out.exr"), 2, "none");
    expectRefused("--output " + path("folder.exr"), 2, "folder.exr: error: The output path is a folder");
    // No one can write to that folder, root included.
    expectRefused("--output /proc/out.exr", 2, "/proc/out.exr: error: The file cannot be created");
    expectRefused("--output /proc/out.png", 2, "/proc/out.png: error: The file cannot be created");
    expectRefused("--stats " + path("none/stats.json"), 2, "none");
    expectRefused("--stats /proc/stats.json", 2, "/proc/stats.json: error: The file cannot be created");
    expectRefused("--frames 0-3 --output /proc/frame-%d.exr", 2,
                  "/proc/frame-0.exr: error: The file cannot be created");
    expectRefused("--frames 0-3 --force --output " + path("frame-%d.exr"), 2,
                  "frame-3.exr: error: The output path is a folder");
    expectRefused("--mode reference --samples 0-3 --output /proc/out.exr", 2,
                  "/proc/out.exr: error: The file cannot be created");
    for (const std::string& writable :
         {"--output " + path("here.exr"), "--output " + path("out.png"), "--stats " + path("stats.json"),
          "--frames 0-2 --output " + path("frame-%d.exr"),
          "--mode reference --samples 0-3 --force --output " + path("here.exr")})
        expectRefused(writable, 4, "mesa-vulkan-drivers");
}

TEST_F(Player, SaysWhichDevicesThereAreWhereNoneMatches)
{
    const std::string scene = path("scene.lumi") + " --output " + path("out.exr");
    expectPlayRefused(scene + " --device nonsense", 4, "no device matches 'nonsense'; devices found:\n  0: ");
    expectPlayRefused(scene + " --device 99", 4, "no device matches '99'");
}

TEST_F(Player, SaysWhatToInstallWhereThereIsNoDriver)
{
    const std::set<std::string> before = files();
    const ProgramRun run = runProgram(
        "/usr/bin/env", fmt::format("VK_ICD_FILENAMES=/none VK_DRIVER_FILES=/none '{}' --headless {} --output {}",
                                    LUMICUT_PLAY, path("scene.lumi"), path("out.exr")));
    expectRefusal(run, before, 4, "mesa-vulkan-drivers");
}

TEST_F(Player, ListsDevicesOnStdout)
{
    const ProgramRun run = runProgram(LUMICUT_PLAY, "--list-devices");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(run.out.starts_with("0: ")) << run.out << run.err;
}

TEST_F(Player, HelpNamesTheExitCodesAndVersionTheVersion)
{
    const ProgramRun help = runProgram(LUMICUT_PLAY, "--help");
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_TRUE(contains(help.out, "Exit codes: 0 ok")) << help.out;
    EXPECT_EQ(runProgram(LUMICUT_PLAY, "--version").out, "lumicut-play " LUMICUT_VERSION "\n");
}

TEST_F(Player, RendersBothModesWithoutAValidationMessage)
{
    const std::string png = render("direct.png", "--spp 2 --mode direct");
    EXPECT_TRUE(png.starts_with(std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x20\0\0\0\x18", 24)));
    for (const std::string mode : {"gi", "direct", "reference"})
    {
        const std::set<std::string> before = files();
        // A message of the layers would stop it.
        render(mode + ".exr", "--validate --spp 2 --mode " + mode + " --stats " + path(mode + ".json"));
        const Result<ImageF> image = readExr(folder_ / (mode + ".exr"));
        ASSERT_TRUE(image) << image.error().message;
        EXPECT_EQ(image->width, 32u);
        EXPECT_EQ(image->height, 24u);
        EXPECT_TRUE(std::ranges::all_of(image->rgb, [](float v) { return v >= 0 && std::isfinite(v); }));
        EXPECT_GT(std::reduce(image->rgb.begin(), image->rgb.end()), 0.0f);
        EXPECT_TRUE(contains(fileBytes(folder_ / (mode + ".json")), "\"samples_per_pixel\": 2"));
        std::set<std::string> expected = before;
        expected.insert({mode + ".exr", mode + ".json"});
        EXPECT_EQ(files(), expected);
    }
}

TEST_F(Player, ShowsTheErrorAgainstARenderingOfTheSameSize)
{
    const std::string against = "--view error --against " + path("reference.exr");
    render("reference.exr", "--mode reference --spp 8");
    render("error.exr", against);
    render("picture.exr", "");
    EXPECT_NE(pixels("error.exr"), pixels("picture.exr"));
    expectPlayRefused(path("scene.lumi") + " " + against + " --size 16x24 --output " + path("out.exr"), 3, "one size");
}

TEST_F(Player, RendersTheSameBytesForTheSameSeedAndOthersForAnother)
{
    for (const std::string mode : {"gi", "direct", "reference"})
    {
        const std::string arguments = "--spp 3 --mode " + mode;
        const std::string picture = render("a.exr", arguments + " --seed 7");
        EXPECT_EQ(picture, render("b.exr", arguments + " --seed 7")) << mode;
        render("c.exr", arguments + " --seed 8");
        EXPECT_NE(pixels("a.exr"), pixels("c.exr")) << mode;
    }
}

TEST_F(Player, OptionsMayStandBeforeTheFile)
{
    const ProgramRun compiled = compile("-q --view a=0,1,4,0,1,0,40 --view b=0,3,4,0,0,0,40 " + path("scene.gltf"));
    EXPECT_EQ(compiled.exit_code, 0) << compiled.err;
    const ProgramRun run = play("--mode direct --camera b --set exposure=1 --set tonemap=srgb " + path("scene.lumi"));
    EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST_F(Player, RendersOnWhenItsPipelineCacheIsDamaged)
{
    ::setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
    const std::string picture = render("a.exr", "--mode direct --spp 1");
    size_t damaged = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "cache/lumicut"))
    {
        std::string bytes = fileBytes(entry.path());
        for (size_t i = 0; i < bytes.size(); i += 7)
            bytes[i] = char(bytes[i] ^ 0x55);
        writeFile(entry.path(), bytes.substr(0, bytes.size() / 2 + 1));
        ++damaged;
    }
    EXPECT_EQ(damaged, 1u);
    EXPECT_EQ(render("b.exr", "--mode direct --spp 1"), picture);
}

TEST_F(Player, ReplacesAnOlderPictureOnlyWhenTheNewOneIsWhole)
{
    writeFile(folder_ / "out.exr", "older");
    expectPlayRefused(path("scene.lumi") + " --camera nowhere --output " + path("out.exr"), 1, "nowhere");
    EXPECT_EQ(fileBytes(folder_ / "out.exr"), "older");
    EXPECT_NE(render("out.exr", "--mode direct --spp 1"), "older");
}

TEST_F(Player, FailedCompilationsLeaveNothingBehind)
{
    std::filesystem::remove(folder_ / "scene.lumi");
    std::filesystem::create_directories(folder_ / "folder/scene.lumi"); // in the package's place
    const auto refused = [&](const std::string& arguments, int code, const std::string& words)
    {
        SCOPED_TRACE(arguments);
        const std::set<std::string> before = files();
        expectRefusal(compile("-q " + arguments), before, code, words);
    };
    refused(path("scene.gltf") + " -o " + path("folder"), 2, "folder");
    refused(path("scene.gltf") + " -o /proc/out.lumi", 2, "cannot create");
    refused("--nonsense", 1, "lumicut-compile: error: ");
    std::filesystem::resize_file(folder_ / "square.bin", 40);
    refused(path("scene.gltf"), 3, "");
    std::filesystem::remove(folder_ / "square.bin");
    refused(path("scene.gltf"), 2, "square.bin");
    writeFile(folder_ / "half.gltf", std::string(kScene).substr(0, 500));
    refused(path("half.gltf"), 3, "half.gltf");
}
} // namespace
