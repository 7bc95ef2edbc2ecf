// lumicut-bench motion from command line to JSON, references kept, and pictures for a contact sheet.
#include "tests/tools/run_program.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace
{
class MotionTest : public testing::Test
{
protected:
    void SetUp() override
    {
        ASSERT_EQ(runProgram(LUMICUT_SCENES, fmt::format("{} cornell", in(""))).exit_code, 0);
        ASSERT_EQ(runProgram(LUMICUT_COMPILE, fmt::format("{} -q", in("cornell.glb"))).exit_code, 0);
    }
    std::string in(const std::string& name) const { return fmt::format("'{}'", (folder_ / name).string()); }

    /// Path tracing at one sample a pixel, of which nothing is remembered, against path tracing at two.
    ProgramRun measure(const std::string& more) const
    {
        return runProgram(LUMICUT_BENCH, fmt::format("motion {} --size 24x16 --spp 2 --mode reference --cache {} --set "
                                                     "history.frames=0 --set antialias.frames=0 --set "
                                                     "denoise.passes=0 {}",
                                                     in("cornell.lumi"), in("kept"), more));
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
    const ProgramRun first = measure(fmt::format("--frames 3 --warm-up 1 --json --dump {}", in("pictures")));
    ASSERT_EQ(first.exit_code, 0) << first.err;
    const auto json = nlohmann::json::parse(first.out);
    EXPECT_EQ(json["schema"], "lumicut-bench-motion/1");
    EXPECT_GT(json["moving_flip"].get<double>(), 0);
    EXPECT_LT(json["moving_flip"].get<double>(), 1);
    ASSERT_EQ(json["mean_ratio"].size(), 3u);
    for (const nlohmann::json& ratio : json["mean_ratio"])
        EXPECT_GT(ratio.get<double>(), 0) << "the frames are lit, and so are their references";
    ASSERT_EQ(json["flicker"].size(), 3u);
    EXPECT_TRUE(json["flicker"][1].is_number());
    EXPECT_TRUE(json["flicker"][2].is_null()) << "three frames, none three apart";
    // A path tracer has no history: all lights and emissions are off at once.
    EXPECT_EQ(json["ghost"], nlohmann::json({0.0, 0.0}));
    EXPECT_EQ(json["ghost_indirect"], nlohmann::json({0.0, 0.0}));
    EXPECT_TRUE(json["reprojected"].is_null());
    EXPECT_GT(json["stages_ms"]["frame"].get<double>(), 0);
    EXPECT_EQ(json["flip_of_frames"].size(), 3u);
    EXPECT_EQ(json["plain_pixels"], 1.0) << "the box has neither mirrors nor glass";
    // It sways by a tenth of a pixel a frame, which uncovers next to nothing.
    EXPECT_LT(json["disoccluded_pixels"].get<double>(), 0.1);
    EXPECT_EQ(keptCount(), 3u);

    const ProgramRun again = measure("--frames 3 --warm-up 1 --json");
    ASSERT_EQ(again.exit_code, 0) << again.err;
    const auto other = nlohmann::json::parse(again.out);
    for (const char* field : {"moving_flip", "mean_ratio", "flicker", "flicker_plain", "flicker_of_references",
                              "flip_of_frames", "ghost", "ghost_indirect"})
        EXPECT_EQ(other[field], json[field]) << field;
    EXPECT_EQ(keptCount(), 3u) << "of the same references";

    const ProgramRun sheet =
        runProgram(LUMICUT_SHEET, fmt::format("{0}/*-frame.png {0}/*-reference.png --columns 3 -o {1}", in("pictures"),
                                              in("sheet.png")));
    EXPECT_EQ(sheet.exit_code, 0) << sheet.err;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "pictures/0002-flip.png"));
}

TEST_F(MotionTest, FollowsACameraPathFromItsFirstKeyOn)
{
    std::ofstream(folder_ / "path.json") << R"({"schema": "lumicut-path/1", "keys": [
        {"time": 5, "camera": "front"}, {"time": 6, "position": [0.5, 1, 3], "forward": [0, 0, -1]}]})";
    const ProgramRun sway = measure("--frames 1 --no-ghost --json");
    ASSERT_EQ(sway.exit_code, 0) << sway.err;
    const ProgramRun run = measure(fmt::format("--path {} --frames 2 --warm-up 0 --no-ghost --json", in("path.json")));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out), of_sway = nlohmann::json::parse(sway.out);
    // Frame 0 of both is the camera "front": the same pictures, the same reference.
    EXPECT_EQ(json["flip_of_frames"][0], of_sway["flip_of_frames"][0]);
    EXPECT_NE(json["flip_of_frames"][1], json["flip_of_frames"][0]);
    EXPECT_EQ(keptCount(), 2u);
    EXPECT_TRUE(json["ghost"][0].is_null());
}

TEST_F(MotionTest, SaysWhatIsWrongWithACameraPath)
{
    const ProgramRun run = measure(fmt::format("--path {}", in("nowhere.json")));
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_NE(run.err.find("nowhere.json"), std::string::npos) << run.err;
}
