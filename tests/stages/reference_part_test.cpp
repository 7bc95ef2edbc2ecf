// Parts of a reference by samples: their sum does not depend on how it was split.
#include "image/read_exr.h"
#include "tests/stages/sequence_folder.h"

#include <cmath>

namespace
{
class ReferencePart : public SequenceFolder
{
protected:
    ProgramRun play(const std::string& arguments) const
    {
        return runProgram(LUMICUT_PLAY,
                          "--headless --mode reference --size 24x16 " + quoted("cornell.lumi") + " " + arguments);
    }
    void render(const std::string& samples, const std::string& name) const
    {
        const ProgramRun run = play("--samples " + samples + " --output " + quoted(name));
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(run.out, "");
    }
    ProgramRun merge(const std::string& arguments) const { return runProgram(LUMICUT_COMPARE, "merge " + arguments); }
    std::string bytes(const std::string& name) const { return fileBytes(folder_ / name); }
};

TEST_F(ReferencePart, AddsUpToTheSameBytesHoweverItIsSplit)
{
    render("0-11", "whole.exr");
    render("0-4", "a.exr");
    render("5-5", "b.exr");
    render("6-11", "c.exr");
    const ProgramRun run = merge(quoted("b.exr") + " " + quoted("none.exr") + " -o " + quoted("x.exr"));
    EXPECT_EQ(run.exit_code, 2) << run.err; // nothing is merged of parts that are missing
    for (const std::string order : {"a b c", "c b a"})
    {
        std::string parts;
        for (const char name : order)
            parts += name == ' ' ? "" : quoted(std::string(1, name) + ".exr") + " ";
        const ProgramRun merged = merge(parts + "-o " + quoted("merged.exr"));
        EXPECT_EQ(merged.exit_code, 0) << merged.err;
        EXPECT_EQ(merged.out, "12 samples a pixel: 0-11\n");
        EXPECT_EQ(bytes("merged.exr"), bytes("whole.exr")) << order;
    }
    // By way of a sum of sums.
    EXPECT_EQ(merge(quoted("a.exr") + " " + quoted("c.exr") + " -o " + quoted("ac.exr")).out,
              "11 samples a pixel: 0-4,6-11\n");
    EXPECT_EQ(merge(quoted("ac.exr") + " " + quoted("b.exr") + " -o " + quoted("abc.exr")).exit_code, 0);
    EXPECT_EQ(bytes("abc.exr"), bytes("whole.exr"));

    // It is the picture of --spp, which adds up in floats, with compensation: to the rounding of a sum and a product.
    ASSERT_EQ(play("--spp 12 --output " + quoted("spp.exr")).exit_code, 0);
    const auto exact = readExr(folder_ / "whole.exr"), rounded = readExr(folder_ / "spp.exr");
    ASSERT_TRUE(exact && rounded);
    for (size_t i = 0; i < exact->rgb.size(); ++i)
        EXPECT_NEAR(exact->rgb[i], rounded->rgb[i], 4 * std::ldexp(exact->rgb[i], -24)) << i;
}

TEST_F(ReferencePart, LeavesAMixedPictureToNobody)
{
    render("0-1", "a.exr");
    const auto time = std::filesystem::last_write_time(folder_ / "a.exr");
    render("0-1", "a.exr");
    EXPECT_EQ(std::filesystem::last_write_time(folder_ / "a.exr"), time);
    const auto refused = [&](const ProgramRun& run, int code, const std::string& words)
    {
        EXPECT_EQ(run.exit_code, code) << words;
        EXPECT_TRUE(contains(run.err, words)) << run.err;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    };
    const std::string output = " --output " + quoted("a.exr");
    refused(play("--samples 0-2" + output), 3, "a.exr: error: is there already with samples 0-1");
    refused(play("--samples 0-1 --seed 3" + output), 3, "(seed 0, not 3)");
    refused(play("--samples 2-1" + output), 1, "comes before");
    refused(play("--samples 0-1 --spp 2" + output), 1, "leave --frames, --spp");
    refused(runProgram(LUMICUT_PLAY, "--headless --samples 0-1 " + quoted("cornell.lumi") + output), 1,
            "--mode reference");
    ASSERT_EQ(play("--samples 1-1 --output " + quoted("twice.exr")).exit_code, 0);
    refused(merge(quoted("a.exr") + " " + quoted("twice.exr") + " -o " + quoted("m.exr")), 3,
            "twice.exr: error: holds sample 1");
    ASSERT_EQ(play("--samples 2-3 --seed 3 --output " + quoted("seed.exr")).exit_code, 0);
    refused(merge(quoted("a.exr") + " " + quoted("seed.exr") + " -o " + quoted("m.exr")), 3, "(seed 3, not 0)");
    ASSERT_EQ(play("--spp 1 --output " + quoted("plain.exr")).exit_code, 0);
    refused(merge(quoted("plain.exr") + " -o " + quoted("m.exr")), 3, "--samples");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "m.exr"));
    EXPECT_EQ(play("--samples 0-2 --force" + output).exit_code, 0);
}
} // namespace
