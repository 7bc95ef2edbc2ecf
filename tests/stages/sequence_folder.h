// What tests of sequences start from.
#pragma once
#include "tests/tools/run_program.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

inline bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// A folder with a package, a path through it, and sequences in folders of their own.
class SequenceFolder : public testing::Test
{
protected:
    void SetUp() override
    {
        ::setenv("XDG_CACHE_HOME", LUMICUT_TEST_CACHE, 1); // pipelines are built once for all tests
        ASSERT_EQ(runProgram(LUMICUT_SCENES, quoted("") + " cornell").exit_code, 0);
        const ProgramRun run = runProgram(LUMICUT_COMPILE, "-q " + quoted("cornell.glb"));
        ASSERT_EQ(run.exit_code, 0) << run.err;
        std::ofstream(folder_ / "path.json") << R"({"schema": "lumicut-path/1", "keys": [{"time": 0, "camera": 0},
            {"time": 1, "position": [0.2, 1, 2.5], "forward": [-0.1, 0, -1]}]})";
    }

    std::string quoted(const std::string& name) const { return fmt::format("'{}'", (folder_ / name).string()); }
    std::set<std::string> files(const std::string& folder) const
    {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / folder))
            names.insert(entry.path().filename().string());
        return names;
    }
    std::string frame(const std::string& folder, const std::string& name) const
    {
        return fileBytes(folder_ / folder / name);
    }
    /// `folder` holds the frames of "whole", with equal bytes, and nothing else.
    void expectWhole(const std::string& folder) const
    {
        EXPECT_EQ(files(folder), files("whole"));
        for (const std::string& name : files("whole"))
            EXPECT_EQ(frame(folder, name), frame("whole", name)) << folder << "/" << name;
    }

    TemporaryFolder folder_;
};

/// The player as a program, in mode direct, which starts fast.
class SequenceProgram : public SequenceFolder
{
protected:
    /// A command that renders small frames into `folder`; many shadow rays make them slow enough to be interrupted.
    std::string command(const std::string& folder, const std::string& arguments) const
    {
        std::filesystem::create_directory(folder_ / folder);
        return fmt::format(
            "--headless {} --path {} --output {} --size 48x32 --fps 12 --mode direct --set direct_samples=64 {}",
            quoted("cornell.lumi"), quoted("path.json"), quoted(folder + "/f%03d.exr"), arguments);
    }
    ProgramRun play(const std::string& folder, const std::string& arguments) const
    {
        return runProgram(LUMICUT_PLAY, command(folder, arguments));
    }
    void expectPlayed(const std::string& folder, const std::string& arguments) const
    {
        const ProgramRun run = play(folder, arguments);
        EXPECT_EQ(run.exit_code, 0) << arguments << run.err;
        EXPECT_EQ(run.out, "");
    }
    /// Sends `signal` as soon as `frame` is there. @return the exit code
    int playUntil(const std::string& folder, const std::string& arguments, const std::string& frame,
                  const char* signal) const
    {
        const std::string script = "-c \"'{}' {} & while [ ! -e {} ]; do sleep 0.01; done; kill -{} \\$!; wait \\$!\"";
        return runProgram("/bin/sh", fmt::format(fmt::runtime(script), LUMICUT_PLAY, command(folder, arguments),
                                                 quoted(folder + "/" + frame), signal))
            .exit_code;
    }
};
