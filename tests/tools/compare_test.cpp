// lumicut-compare as its user meets it: output, exit codes, files.
#include "image/write_image.h"
#include "tests/tools/random_image.h"
#include "tests/tools/run_program.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

namespace
{

ProgramRun compare(const std::string& arguments)
{
    return runProgram(LUMICUT_COMPARE, arguments);
}

class Compare : public testing::Test
{
protected:
    void SetUp() override
    {
        ASSERT_TRUE(writeExr(folder_ / "a.exr", randomImage(20, 10, 1, 2.0f)));
        ASSERT_TRUE(writeExr(folder_ / "b.exr", randomImage(20, 10, 2, 2.0f)));
        ASSERT_TRUE(writeExr(folder_ / "small.exr", randomImage(10, 10, 3)));
    }
    std::string file(const std::string& name) const { return (folder_ / name).string(); }
    std::string pair() const { return file("a.exr") + " " + file("b.exr"); }

    TemporaryFolder folder_;
};

TEST_F(Compare, JsonIsTheWholeOfStdout)
{
    const ProgramRun run = compare(pair() + " --json");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    const nlohmann::json json = nlohmann::json::parse(run.out, nullptr, false);
    ASSERT_FALSE(json.is_discarded()) << run.out;
    EXPECT_EQ(json["width"], 20);
    EXPECT_EQ(json["nonfinite_pixels"]["test"], 0);
    EXPECT_EQ(json["mean_ratio"].size(), 3u);
    for (const char* key : {"rmse", "relmse", "relmse_trimmed", "hdr_flip", "ldr_flip"})
        EXPECT_GT(json[key].get<double>(), 0) << key;
    EXPECT_GT(json["relmse"], json["relmse_trimmed"]);
}

TEST_F(Compare, TsvIsOneLineOfTheFiguresOfJson)
{
    const ProgramRun run = compare(pair() + " --tsv"), json_run = compare(pair() + " --json");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const nlohmann::json json = nlohmann::json::parse(json_run.out);
    const std::vector<double> expected{
        json["mean_ratio"][0],  json["mean_ratio"][1],  json["mean_ratio"][2], json["relmse"],
        json["relmse_trimmed"], json["ldr_flip"],       json["hdr_flip"],      0,
        json["bias_z"],         json["mean_difference"]};
    std::istringstream text(run.out);
    std::vector<double> figures;
    for (double figure; text >> figure;)
        figures.push_back(figure);
    ASSERT_EQ(figures.size(), expected.size()) << run.out;
    for (size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(figures[i], expected[i], 1e-6 + 1e-5 * std::abs(expected[i])) << i; // as many digits as are printed
    EXPECT_EQ(std::ranges::count(run.out, '\n'), 1);
    EXPECT_EQ(compare(pair() + " --tsv --json").exit_code, 1);
}

TEST_F(Compare, CropLooksAtThatPartOnly)
{
    ImageF changed = randomImage(20, 10, 1, 2.0f);
    changed.rgb[3 * (5 * 20 + 15)] += 10;
    ASSERT_TRUE(writeExr(folder_ / "changed.exr", changed));
    const auto rmse = [&](const std::string& crop)
    {
        const ProgramRun run = compare(file("a.exr") + " " + file("changed.exr") + " --json --crop " + crop);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return nlohmann::json::parse(run.out)["rmse"].get<double>();
    };
    EXPECT_EQ(rmse("0,0,15,10"), 0);
    EXPECT_NEAR(rmse("15,5,16,6"), 10 / std::sqrt(3.0), 1e-5);
}

TEST_F(Compare, WritesThePictureItWasAskedFor)
{
    const ProgramRun run = compare(pair() + " --png " + file("side.png") + " --flip-map");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(fileBytes(folder_ / "side.png").substr(1, 3), "PNG");
}

TEST_F(Compare, NonFinitePixelsAreReported)
{
    ImageF broken = randomImage(20, 10, 2, 2.0f);
    broken.rgb[7] = std::numeric_limits<float>::quiet_NaN();
    ASSERT_TRUE(writeExr(folder_ / "nan.exr", broken));
    const ProgramRun run = compare(file("a.exr") + " " + file("nan.exr") + " --json");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["nonfinite_pixels"]["test"], 1);
    EXPECT_EQ(json["nonfinite_pixels"]["reference"], 0);
}

// ---- --welch --------------------------------------------------------------------------------------------------------

class CompareSets : public Compare
{
protected:
    void SetUp() override
    {
        Compare::SetUp();
        for (uint32_t i = 0; i < 8; ++i) // four of values 0 to 2, four of 0 to 4
            ASSERT_TRUE(writeExr(name(i), randomImage(20, 10, 10 + i, i < 4 ? 2.0f : 4.0f)));
    }
    std::string name(uint32_t i) const { return file(std::string(1, char('0' + i)).append(".exr")); }
    std::string sets(uint32_t first_a, uint32_t first_b, uint32_t count) const
    {
        std::string all;
        for (const uint32_t first : {first_a, first_b})
        {
            all.append(first == first_a ? "--welch" : " --against");
            for (uint32_t i = first; i < first + count; ++i)
                all.append(" ").append(name(i));
        }
        return all;
    }
    std::string equal() const { return sets(0, 2, 2); }
    std::string different() const { return sets(4, 0, 4); }
};

TEST_F(CompareSets, TellNoiseFromADifference)
{
    for (const bool differ : {false, true})
    {
        const std::string arguments = (differ ? different() : equal()) + " --tile 5";
        const ProgramRun run = compare(arguments + " --json");
        ASSERT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(run.err, "");
        const nlohmann::json json = nlohmann::json::parse(run.out);
        EXPECT_EQ(json["differ"], differ);
        EXPECT_EQ(json["test_count"], 3 * (4 * 2 + 1));
        EXPECT_EQ(json["smallest"]["p"] < json["threshold"], differ);
        EXPECT_EQ(json["below_count"] > 0, differ);
        EXPECT_NEAR(json["mean_ratio"][0].get<double>(), differ ? 2 : 1, 5 * json["mean_ratio_error"][0].get<double>());
        const ProgramRun text = compare(arguments);
        EXPECT_EQ(text.out.find(differ ? "differ" : "no difference found"), 16u) << text.out;
    }
}

TEST_F(CompareSets, TsvIsOneLineOfTheFiguresOfJson)
{
    const ProgramRun run = compare(different() + " --tsv"), json_run = compare(different() + " --json");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const nlohmann::json json = nlohmann::json::parse(json_run.out);
    const nlohmann::json &ratio = json["mean_ratio"], &error = json["mean_ratio_error"];
    const std::vector<double> expected{1,
                                       json["smallest"]["p"],
                                       json["threshold"],
                                       json["below_count"],
                                       json["test_count"],
                                       ratio[0],
                                       ratio[1],
                                       ratio[2],
                                       error[0],
                                       error[1],
                                       error[2],
                                       0};
    std::istringstream text(run.out);
    std::vector<double> figures;
    for (double figure; text >> figure;)
        figures.push_back(figure);
    ASSERT_EQ(figures.size(), expected.size()) << run.out;
    for (size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(figures[i], expected[i], 1e-6 + 1e-5 * expected[i]) << i;
    EXPECT_EQ(std::ranges::count(run.out, '\n'), 1);
}

TEST_F(CompareSets, MapHasAPixelATile)
{
    const ProgramRun run = compare(different() + " --p-map " + file("p.png"));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const std::string bytes = fileBytes(folder_ / "p.png");
    ASSERT_GT(bytes.size(), 24u);
    EXPECT_EQ(bytes[19], 3); // width and height of a PNG's header: 20 x 10 pixels in tiles of 8
    EXPECT_EQ(bytes[23], 2);
}

struct Fault
{
    const char* name;
    const char* arguments; // @ is the folder
    int exit_code;
    const char* words;
};

class CompareFaults : public Compare, public testing::WithParamInterface<Fault>
{
};

TEST_P(CompareFaults, GetASentenceAndTheDocumentedCode)
{
    std::string arguments = GetParam().arguments;
    for (size_t at = arguments.find('@'); at != std::string::npos; at = arguments.find('@'))
        arguments.replace(at, 1, folder_.path().string());
    const ProgramRun run = compare(arguments);
    EXPECT_EQ(run.exit_code, GetParam().exit_code) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_NE(run.err.find(GetParam().words), std::string::npos) << run.err;
    EXPECT_EQ(run.err.find('\x1b'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    All, CompareFaults,
    testing::Values(Fault{"NoArguments", "", 1, "REFERENCE"},
                    Fault{"UnknownOption", "@/a.exr @/b.exr --wrong", 1, "--wrong"},
                    Fault{"ShortCrop", "@/a.exr @/b.exr --crop 1,2,3", 1, "--crop"},
                    Fault{"CropOutside", "@/a.exr @/b.exr --crop 0,0,21,10", 1, "20 x 10"},
                    Fault{"EmptyCrop", "@/a.exr @/b.exr --crop 5,5,5,6", 1, "does not lie"},
                    Fault{"MissingFile", "@/a.exr @/none.exr", 2,
                          "none.exr: error: cannot open the file: No such file"},
                    Fault{"Folder", "@ @/b.exr", 2, "this is a directory"},
                    Fault{"SizesDiffer", "@/a.exr @/small.exr", 3, "10 x 10 pixels but the reference"},
                    Fault{"NotAnImage", "/bin/sh @/b.exr", 3, "not an OpenEXR"},
                    Fault{"WelchOfOnePicture", "--welch @/a.exr --against @/a.exr @/b.exr", 1, "at least 2 to each"},
                    Fault{"WelchAgainstOnePicture", "--welch @/a.exr @/b.exr --against @/b.exr", 1, "--against 1"},
                    Fault{"WelchAgainstNothing", "--welch @/a.exr @/b.exr", 1, "--against"},
                    Fault{"AgainstAlone", "--against @/a.exr @/b.exr", 1, "--welch"},
                    Fault{"WelchWithAReference", "@/a.exr @/b.exr --welch @/a.exr @/b.exr --against @/a.exr @/b.exr", 1,
                          "REFERENCE"},
                    Fault{"WelchOfSizes", "--welch @/a.exr @/b.exr --against @/a.exr @/small.exr", 3,
                          "10 x 10 pixels but the first picture"},
                    Fault{"WelchOfAMissingFile", "--welch @/a.exr @/none.exr --against @/a.exr @/b.exr", 2, "none.exr"},
                    Fault{"UnwritableMap", "--welch @/a.exr @/b.exr --against @/a.exr @/b.exr --p-map @/no/p.png", 2,
                          "No such file or directory"},
                    Fault{"UnwritablePicture", "@/a.exr @/b.exr --png @/no/side.png", 2, "No such file or directory"}),
    [](const auto& test) { return std::string(test.param.name); });

} // namespace
