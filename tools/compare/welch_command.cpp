#include "tools/compare/welch_command.h"

#include "image/write_image.h"
#include "tools/compare/metrics.h"
#include "tools/compare/picture.h"
#include "tools/compare/read_images.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>

namespace
{

constexpr std::array<const char*, 3> kChannels{"red", "green", "blue"};

struct Sets
{
    std::vector<ImageF> a, b;
    uint64_t nonfinite_a = 0, nonfinite_b = 0;
};

std::string placeOf(const WelchResult& r)
{
    if (r.smallest.is_whole)
        return "the whole picture";
    return fmt::format("the tile at pixel {}, {}", r.smallest.tile_x * r.tile, r.smallest.tile_y * r.tile);
}

std::string jsonText(const WelchResult& r, const Sets& sets)
{
    nlohmann::ordered_json json;
    json["width"] = sets.a[0].width;
    json["height"] = sets.a[0].height;
    json["pictures"] = {{"set", sets.a.size()}, {"against", sets.b.size()}};
    json["nonfinite_pixels"] = {{"set", sets.nonfinite_a}, {"against", sets.nonfinite_b}};
    json["differ"] = r.differ();
    json["tile"] = r.tile;
    json["test_count"] = r.tests.size();
    json["threshold"] = r.threshold;
    json["below_count"] = r.below_count;
    json["smallest"] = {
        {"p", r.smallest.p}, {"channel", kChannels[r.smallest.channel]}, {"difference", r.smallest.difference}};
    if (!r.smallest.is_whole)
        json["smallest"]["pixel"] = {r.smallest.tile_x * r.tile, r.smallest.tile_y * r.tile};
    json["mean_set"] = r.mean_a;
    json["mean_against"] = r.mean_b;
    json["mean_ratio"] = r.mean_ratio;
    json["mean_ratio_error"] = r.ratio_error;
    return json.dump(2) + "\n";
}

/// One line for scripts, see tools/compare/README.md.
std::string tsvText(const WelchResult& r, const Sets& sets)
{
    return fmt::format("{}\t{:.6g}\t{:.6g}\t{}\t{}\t{:.6f}\t{:.6f}\t{:.6f}\t{:.6g}\t{:.6g}\t{:.6g}\t{}\n",
                       r.differ() ? 1 : 0, r.smallest.p, r.threshold, r.below_count, r.tests.size(), r.mean_ratio[0],
                       r.mean_ratio[1], r.mean_ratio[2], r.ratio_error[0], r.ratio_error[1], r.ratio_error[2],
                       sets.nonfinite_a + sets.nonfinite_b);
}

std::string plainText(const WelchResult& r, const Sets& sets)
{
    const auto ratio = [&](size_t c) { return fmt::format("{:.5f} +- {:.5f}", r.mean_ratio[c], r.ratio_error[c]); };
    return fmt::format("result          {}\n"
                       "size            {} x {}, {} pictures against {}\n"
                       "non-finite      {} and {} pixels (taken as black)\n"
                       "tests           {} of tiles of {} x {} and of the whole picture, by channel\n"
                       "threshold       {:.4g}; {} tests below it\n"
                       "smallest p      {:.4g} ({} of {}, difference {:.4g})\n"
                       "mean ratio      {}   {}   {}\n",
                       r.differ() ? "differ" : "no difference found", sets.a[0].width, sets.a[0].height, sets.a.size(),
                       sets.b.size(), sets.nonfinite_a, sets.nonfinite_b, r.tests.size(), r.tile, r.tile, r.threshold,
                       r.below_count, r.smallest.p, kChannels[r.smallest.channel], placeOf(r), r.smallest.difference,
                       ratio(0), ratio(1), ratio(2));
}

Status writeMap(const std::string& file, const WelchResult& result)
{
    const Picture picture = pValueMap(result);
    return writePng(file, picture.width, picture.height, 3, picture.rgb);
}

} // namespace

void addWelchOptions(CLI::App& app, WelchOptions& options)
{
    CLI::Option* welch =
        app.add_option("--welch", options.set,
                       "renderings that differ in their seeds alone; says whether their mean differs from that of "
                       "the renderings of --against (.exr, at least 2 each)");
    for (const char* other : {"REFERENCE", "TEST", "--png", "--flip-map", "--exposure"})
        welch->excludes(app.get_option(other));
    CLI::Option* against = app.add_option("--against", options.against, "the other set for --welch")->needs(welch);
    welch->needs(against);
    app.add_option("--tile", options.tile, "side in pixels of the tiles that --welch tests [8]")
        ->check(CLI::Range(1u, 1u << 14))
        ->needs(welch);
    app.add_option("--alpha", options.alpha, "chance that --welch finds a difference where there is none [0.01]")
        ->check(CLI::Range(1e-9, 0.5))
        ->needs(welch);
    app.add_option(
           "--p-map", options.p_map,
           "write a pixel a tile: its p as grey; red or blue where --welch finds the set too bright or dark (.png)")
        ->needs(welch);
}

int runWelch(const WelchOptions& options, const std::vector<uint32_t>& crop, Output output)
{
    if (options.set.size() < 2 || options.against.size() < 2)
        return fail("--welch",
                    {ExitCode::kUsage,
                     fmt::format("A set's noise shows from two pictures on, but --welch has {} and --against {}; "
                                 "give at least 2 to each, rendered with different seeds.",
                                 options.set.size(), options.against.size())});
    std::vector<std::string> files = options.set;
    files.insert(files.end(), options.against.begin(), options.against.end());
    Sets sets;
    if (const auto failed = readImages(files, crop, "first picture", sets.a))
        return *failed;
    sets.b.assign(std::make_move_iterator(sets.a.begin() + std::ptrdiff_t(options.set.size())),
                  std::make_move_iterator(sets.a.end()));
    sets.a.resize(options.set.size());
    for (ImageF& image : sets.a)
        sets.nonfinite_a += blackenNonFinite(image);
    for (ImageF& image : sets.b)
        sets.nonfinite_b += blackenNonFinite(image);

    const WelchResult result = welch(sets.a, sets.b, options.tile, options.alpha);
    if (!options.p_map.empty())
        if (const Status written = writeMap(options.p_map, result); !written)
            return fail(options.p_map, written.error());
    fmt::print("{}", output == Output::kJson  ? jsonText(result, sets)
                     : output == Output::kTsv ? tsvText(result, sets)
                                              : plainText(result, sets));
    return int(ExitCode::kOk);
}
