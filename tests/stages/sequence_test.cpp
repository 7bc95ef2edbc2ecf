// Sequences of lumicut-play: the same bytes however a sequence is split or interrupted, and what is said of bad
// requests.
#include "tests/tools/run_program.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

namespace
{
bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// A folder with a package, a path through it, and sequences in folders of their own.
class Sequence : public testing::Test
{
protected:
    static void SetUpTestSuite()
    {
        ::setenv("XDG_CACHE_HOME", LUMICUT_TEST_CACHE, 1); // pipelines are built once for all tests
        folder_ = new TemporaryFolder;
        ASSERT_EQ(runProgram(LUMICUT_SCENES, quoted("") + " cornell").exit_code, 0);
        const ProgramRun run = runProgram(LUMICUT_COMPILE, "-q " + quoted("cornell.glb"));
        ASSERT_EQ(run.exit_code, 0) << run.err;
        std::ofstream(*folder_ / "path.json") << R"({"schema": "lumicut-path/1", "keys": [{"time": 0, "camera": 0},
            {"time": 1, "position": [0.2, 1, 2.5], "forward": [-0.1, 0, -1]}]})";
    }
    static void TearDownTestSuite() { delete folder_; }

    static std::string quoted(const std::string& name) { return fmt::format("'{}'", (*folder_ / name).string()); }

    /// A command that renders small frames into `folder`.
    static std::string command(const std::string& folder, const std::string& arguments)
    {
        std::filesystem::create_directory(*folder_ / folder);
        return fmt::format(
            "--headless {} --path {} --output {} --size 24x16 --fps 12 --preset preview --set photons.count=500 "
            "--set samples.count=64 {}",
            quoted("cornell.lumi"), quoted("path.json"), quoted(folder + "/f%03d.exr"), arguments);
    }
    static ProgramRun play(const std::string& folder, const std::string& arguments)
    {
        return runProgram(LUMICUT_PLAY, command(folder, arguments));
    }
    static void expectPlayed(const std::string& folder, const std::string& arguments)
    {
        const ProgramRun run = play(folder, arguments);
        EXPECT_EQ(run.exit_code, 0) << arguments << run.err;
        EXPECT_EQ(run.out, "");
    }
    /// Sends `signal` as soon as `frame` is there. @return the exit code
    static int playUntil(const std::string& folder, const std::string& arguments, const std::string& frame,
                         const char* signal)
    {
        const ProgramRun run = runProgram(
            "/bin/sh", fmt::format("-c \"'{}' {} & while [ ! -e {} ]; do sleep 0.01; done; kill -{} \\$!; wait \\$!\"",
                                   LUMICUT_PLAY, command(folder, arguments), quoted(folder + "/" + frame), signal));
        return run.exit_code;
    }
    static std::set<std::string> files(const std::string& folder)
    {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(*folder_ / folder))
            names.insert(entry.path().filename().string());
        return names;
    }
    static std::string frame(const std::string& folder, const std::string& name)
    {
        return fileBytes(*folder_ / (folder + "/" + name));
    }

    /// `folder` holds the frames of "whole", with equal bytes, and nothing else.
    static void expectWhole(const std::string& folder)
    {
        EXPECT_EQ(files(folder), files("whole"));
        for (const std::string& name : files("whole"))
            EXPECT_EQ(frame(folder, name), frame("whole", name)) << folder << "/" << name;
    }
    static void expectSameInPieces();
    static void expectSameAfterAKill();
    static void expectSameAfterTermination();
    static void expectWholeFramesAreLeftAlone();
    static void expectNoDeviceIsNeeded();

    static inline TemporaryFolder* folder_ = nullptr;
};

void Sequence::expectSameInPieces()
{
    for (const std::string piece : {"9-11", "0-2", "6-8", "3-5"})
        expectPlayed("pieces", "--frames " + piece);
    expectWhole("pieces");
}

void Sequence::expectSameAfterAKill()
{
    EXPECT_EQ(playUntil("killed", "--frames 0-11", "f004.exr", "KILL"), 128 + 9);
    const std::set<std::string> left = files("killed");
    EXPECT_LT(left.size(), 12u);
    expectPlayed("killed", "--frames 0-11");
    for (const std::string& name : left)
        if (name.ends_with(".tmp")) // no program can remove it
            std::filesystem::remove(*folder_ / "killed" / name);
    expectWhole("killed");
}

void Sequence::expectSameAfterTermination()
{
    EXPECT_EQ(playUntil("ended", "--frames 0-11", "f002.exr", "TERM"), 128 + 15);
    const std::set<std::string> left = files("ended");
    EXPECT_LT(left.size(), 12u);
    for (const std::string& name : left)
        EXPECT_EQ(frame("ended", name), frame("whole", name)) << name;
    expectPlayed("ended", "--frames 0-11");
    expectWhole("ended");
}

void Sequence::expectWholeFramesAreLeftAlone()
{
    std::filesystem::copy(*folder_ / "whole", *folder_ / "resumed");
    const auto write_time = [&](const char* name)
    { return std::filesystem::last_write_time(*folder_ / "resumed" / name); };
    std::filesystem::resize_file(*folder_ / "resumed/f005.exr", 300);
    std::filesystem::remove(*folder_ / "resumed/f007.exr");
    const ProgramRun list = play("resumed", "--frames 0-12 --list-missing");
    EXPECT_EQ(list.exit_code, 0) << list.err;
    EXPECT_EQ(list.out, "5\n7\n12\n");

    const auto before = write_time("f004.exr");
    expectPlayed("resumed", "--frames 0-11");
    expectWhole("resumed");
    EXPECT_EQ(write_time("f004.exr"), before);
    expectPlayed("resumed", "--frames 4-4 --force");
    expectWhole("resumed");
    EXPECT_NE(write_time("f004.exr"), before);
}

void Sequence::expectNoDeviceIsNeeded()
{
    const ProgramRun run =
        runProgram("/usr/bin/env", fmt::format("VK_ICD_FILENAMES=/none VK_DRIVER_FILES=/none '{}' {}", LUMICUT_PLAY,
                                               command("whole", "--frames 0-11 --stats " + quoted("stats.json"))));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(contains(fileBytes(*folder_ / "stats.json"), "\"submissions\": 0")) << run.err;
}

TEST_F(Sequence, HasTheSameBytesHoweverItIsSplitOrInterrupted)
{
    expectPlayed("whole", "--frames 0-11");
    ASSERT_EQ(files("whole").size(), 12u);
    EXPECT_NE(frame("whole", "f000.exr"), frame("whole", "f011.exr"));
    expectSameInPieces();
    expectSameAfterAKill();
    expectSameAfterTermination();
    expectWholeFramesAreLeftAlone();
    expectNoDeviceIsNeeded();
}

TEST_F(Sequence, BlocksBeginAnew)
{
    expectPlayed("across", "--frames 31-33"); // blocks have 32 frames
    expectPlayed("beyond", "--frames 32-33");
    EXPECT_EQ(frame("across", "f032.exr"), frame("beyond", "f032.exr"));
    EXPECT_EQ(frame("across", "f033.exr"), frame("beyond", "f033.exr"));
}

TEST_F(Sequence, OfStandingFramesIsOneOfStillPictures)
{
    expectPlayed("still", "--frames 0-1 --spp 2");
    expectPlayed("second", "--frames 1-1 --spp 2");
    EXPECT_EQ(frame("still", "f001.exr"), frame("second", "f001.exr"));
    const ProgramRun run = runProgram(
        LUMICUT_PLAY, fmt::format("--headless {} --output {} --size 24x16 --preset preview --set photons.count=500 "
                                  "--set samples.count=64 --spp 2",
                                  quoted("cornell.lumi"), quoted("still/picture.exr")));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(frame("still", "f000.exr"), frame("still", "picture.exr")); // frame 0 of seed 0 has seed 0
}

TEST_F(Sequence, BadRequestsAreRefusedInASentence)
{
    const auto refused = [&](const std::string& arguments, int code, const std::string& words)
    {
        SCOPED_TRACE(arguments);
        const ProgramRun run = runProgram(LUMICUT_PLAY, quoted("cornell.lumi") + " " + arguments);
        EXPECT_EQ(run.exit_code, code);
        EXPECT_TRUE(contains(run.err, words)) << run.err;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
        EXPECT_EQ(run.out, "");
    };
    std::filesystem::create_directory(*folder_ / "refused");
    const std::string path = "--path " + quoted("path.json"), output = " --output " + quoted("refused/f%d.exr");
    const std::string sequence = "--headless " + path + output + " --size 24x16 ";
    refused(sequence + "--frames 5-3", 1, "comes before");
    for (const std::string range : {"3-", "1-2-3", "a-b", "0-99999999", "''"})
        refused(sequence + "--frames " + range, 1, "--frames: ");
    refused("--headless --frames 0-3" + output, 1, "--path FILE");
    refused("--headless --frames 0-3 " + path, 1, "--output frame-%04d.exr");
    refused(sequence, 1, "--frames A-B");
    refused(sequence + "--frames 3", 1, "--frames A-B");
    refused(path + " --frames 0-3" + output, 1, "--headless");
    refused(sequence + "--frames 0-3 --camera 0", 1, "give one");
    refused("--headless --fps 12", 1, "--fps is for sequences");
    refused("--headless --list-missing", 1, "--list-missing is for sequences");
    refused(sequence + "--frames 0-3 --fps 0", 1, "--fps");
    for (const std::string name :
         {"f.exr", "f%s.exr", "f%5d.exr", "f%d%d.exr", "f%%d.exr", "f%.exr", "f%0d.exr", "%d/f.exr", "%d/f%d.exr"})
        refused("--headless --frames 0-3 " + path + " --output " + quoted("refused/" + name), 1, "%d or %0Nd");
    refused("--headless --frames 0-3 " + path + " --output " + quoted("refused/f%d.jpg"), 1, ".exr or .png");
    refused("--headless --frames 0-3 " + path + " --output " + quoted("none/f%d.exr"), 2, "none");
    refused("--headless --frames 0-3" + output + " --path " + quoted("none.json"), 2, "none.json: error: ");
    refused("--headless --frames 0-3" + output + " --path " + quoted("cornell.lumi"), 3, "JSON");
    std::ofstream(*folder_ / "empty.json") << R"({"schema": "lumicut-path/1", "keys": []})";
    refused("--headless --frames 0-3" + output + " --path " + quoted("empty.json"), 3, "(/keys)");
    EXPECT_EQ(files("refused"), std::set<std::string>());
    std::ofstream(*folder_ / "refused/f2.exr") << "notes";
    refused(sequence + "--frames 0-3", 2, "f2.exr: error: is there already");
    refused(sequence + "--frames 0-3 --list-missing", 2, "--force");
    EXPECT_EQ(files("refused"), std::set<std::string>{"f2.exr"});
}
} // namespace
