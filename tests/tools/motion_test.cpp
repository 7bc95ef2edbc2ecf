// lumicut-bench motion from command line to JSON, references kept, and pictures for a contact sheet.
#include "tests/tools/run_program.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace
{
class MotionTest : public testing::Test
{
protected:
    void SetUp() override
    {
        ASSERT_EQ(runProgram(LUMICUT_SCENES, in("") + " cornell").exit_code, 0);
        ASSERT_EQ(runProgram(LUMICUT_COMPILE, in("cornell.glb") + " -q").exit_code, 0);
    }
    std::string in(const std::string& name) const { return "'" + (folder_ / name).string() + "'"; }

    ProgramRun measure(const std::string& more) const
    {
        return runProgram(LUMICUT_BENCH, "motion " + in("cornell.lumi") + " --size 24x16 --frames 3 --warm-up 1 --spp 2 --mode direct --cache " +
                                             in("kept") + " " + more);
    }
    size_t keptCount() const
    {
        const std::filesystem::directory_iterator files(folder_ / "kept");
        return size_t(std::distance(begin(files), end(files)));
    }

    TemporaryFolder folder_;
};
} // namespace

TEST_F(MotionTest, MeasuresASequenceAndKeepsItsReferences)
{
    const ProgramRun first = measure("--json --dump " + in("pictures"));
    ASSERT_EQ(first.exit_code, 0) << first.err;
    const auto json = nlohmann::json::parse(first.out);
    EXPECT_EQ(json["schema"], "lumicut-bench-motion/1");
    EXPECT_GT(json["moving_flip"].get<double>(), 0);
    EXPECT_LT(json["moving_flip"].get<double>(), 1);
    EXPECT_EQ(json["flicker"].size(), 3u);
    // Mode direct remembers nothing.
    EXPECT_EQ(json["ghost"], nlohmann::json({0.0, 0.0}));
    EXPECT_TRUE(json["reprojected"].is_null());
    EXPECT_GT(json["stages_ms"]["frame"].get<double>(), 0);
    EXPECT_EQ(json["flip_of_frames"].size(), 3u);
    EXPECT_EQ(keptCount(), 3u);

    const ProgramRun again = measure("--json");
    ASSERT_EQ(again.exit_code, 0) << again.err;
    const auto other = nlohmann::json::parse(again.out);
    for (const char* field : {"moving_flip", "flicker", "flicker_plain", "flicker_of_references", "flip_of_frames", "ghost"})
        EXPECT_EQ(other[field], json[field]) << field;
    EXPECT_EQ(keptCount(), 3u) << "of the same references";

    const ProgramRun sheet = runProgram(LUMICUT_SHEET, in("pictures") + "/*-frame.png " + in("pictures") + "/*-reference.png --columns 3 -o " + in("sheet.png"));
    EXPECT_EQ(sheet.exit_code, 0) << sheet.err;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "pictures/0002-flip.png"));
}

TEST_F(MotionTest, SaysWhatIsWrongWithACameraPath)
{
    const ProgramRun run = measure("--path " + in("nowhere.json"));
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_NE(run.err.find("nowhere.json"), std::string::npos) << run.err;
}
