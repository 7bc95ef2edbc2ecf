// lumicut-play as a task of a farm: what its frames say of themselves, and how it ends.
#include "image/picture_origin.h"
#include "tests/stages/sequence_folder.h"

namespace
{
class FarmTask : public SequenceProgram
{
protected:
    /// @param failure as tests/stages/failing_device.cpp takes it
    ProgramRun playWith(const std::string& failure, const std::string& folder, const std::string& arguments) const
    {
        return runProgram("/usr/bin/env",
                          fmt::format("LD_PRELOAD={} LUMICUT_TEST_FAILURE={} LUMICUT_TEST_FILE={} '{}' {}",
                                      LUMICUT_FAILING_DEVICE, failure, quoted("cornell.lumi"), LUMICUT_PLAY,
                                      command(folder, arguments)));
    }
    void expectRefused(const std::string& arguments, const std::string& words) const
    {
        const ProgramRun run = play("film", arguments);
        EXPECT_EQ(run.exit_code, 3) << arguments << run.err;
        EXPECT_TRUE(contains(run.err, words)) << run.err;
        EXPECT_TRUE(contains(run.err, "film/f000.exr: error: ")) << run.err;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    }
};

TEST_F(FarmTask, LeavesAMixedFilmToNobody)
{
    expectPlayed("film", "--frames 0-0");
    const auto origin = readOrigin(folder_ / "film/f000.exr");
    ASSERT_TRUE(origin) << origin.error().message;
    const ProgramRun info = runProgram(LUMICUT_PLAY, "--version");
    EXPECT_EQ("lumicut-play " + origin->version.substr(0, origin->version.find(' ')) + "\n", info.out);
    EXPECT_TRUE(contains(origin->settings, "\ndirect_samples 64\n")) << origin->settings;
    EXPECT_NE(origin->device, "");

    expectRefused("--frames 0-3 --seed 1", "(seed 0, not 1)");
    expectRefused("--frames 0-3 --set exposure=1", "(exposure 0, not 1)");
    expectRefused("--frames 0-3 --time 0.5 --list-missing", "(time none, not 0.5)");
    expectPlayed("film", "--frames 0-1"); // what is as it was goes on
    std::ofstream(folder_ / "path.json") << R"({"schema": "lumicut-path/1", "keys": [{"time": 0, "camera": 0},
            {"time": 1, "position": [0.3, 1, 2.5], "forward": [-0.1, 0, -1]}]})";
    expectRefused("--frames 0-3", "(path ");
    ASSERT_EQ(runProgram(LUMICUT_COMPILE, "-q --default-light on " + quoted("cornell.glb")).exit_code, 0);
    expectRefused("--frames 0-3", "another package");
    EXPECT_EQ(files("film"), (std::set<std::string>{"f000.exr", "f001.exr"}));
    expectPlayed("film", "--frames 0-1 --force");
    expectPlayed("film", "--frames 0-2");
}

TEST_F(FarmTask, SaysThatAnotherTryMaySucceed)
{
    expectPlayed("whole", "--frames 0-2");
    for (const char* failure : {"lost:1", "memory:5"})
    {
        const ProgramRun run = playWith(failure, "tried", "--frames 0-2");
        EXPECT_EQ(run.exit_code, 75) << failure << run.err;
        EXPECT_TRUE(contains(run.err, "another try may succeed")) << run.err;
        EXPECT_LT(files("tried").size(), 3u) << failure;
        for (const std::string& name : files("tried")) // and no temporary file
            EXPECT_EQ(frame("tried", name), frame("whole", name)) << name;
    }
    expectPlayed("tried", "--frames 0-2");
    expectWhole("tried");
}

TEST_F(FarmTask, NamesAFullDiskAndAVanishedShareInALine)
{
    expectPlayed("whole", "--frames 0-2");
    const ProgramRun full = playWith("full:1", "full", "--frames 0-2");
    EXPECT_EQ(full.exit_code, 2) << full.err;
    EXPECT_TRUE(contains(full.err, "f001.exr: error: The file cannot be written: No space left on device."))
        << full.err;
    EXPECT_EQ(files("full"), std::set<std::string>{"f000.exr"});
    EXPECT_EQ(frame("full", "f000.exr"), frame("whole", "f000.exr"));

    const ProgramRun gone = playWith("vanish:1", "gone", "--frames 0-2");
    EXPECT_EQ(gone.exit_code, 2) << gone.err;
    EXPECT_TRUE(contains(gone.err, "error: a file that was opened cannot be read any more")) << gone.err;
    EXPECT_EQ(files("gone"), std::set<std::string>());
}

TEST_F(FarmTask, EndsInTheMiddleOfAStepThatTakesTooLong)
{
    expectPlayed("whole", "--frames 0-1");
    const ProgramRun run = playWith("stuck:1", "stuck", "--frames 0-1");
    EXPECT_EQ(run.exit_code, 143) << run.err;
    EXPECT_TRUE(contains(run.err, "before the step at work was done")) << run.err;
    for (const std::string& name : files("stuck"))
        EXPECT_EQ(frame("stuck", name), frame("whole", name)) << name;
}
} // namespace
