// lumicut-compare: error metrics and difference pictures of two renderings.
#include "image/write_image.h"
#include "tools/cli/documentation.h"
#include "tools/compare/flip.h"
#include "tools/compare/merge_command.h"
#include "tools/compare/metrics.h"
#include "tools/compare/picture.h"
#include "tools/compare/read_images.h"
#include "tools/compare/welch_command.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace
{

struct Options
{
    std::string reference, test, png;
    float exposure = 0;
    bool json = false;
    bool tsv = false;
    bool flip_panel = false;
    std::vector<uint32_t> crop; // X0,Y0,X1,Y1 or empty
    WelchOptions welch;
};

struct Report
{
    uint32_t width, height;
    Metrics metrics;
    FlipExposures exposures;
    FlipMap hdr, ldr;
};

ImageF scaled(const ImageF& image, float factor)
{
    ImageF result = image;
    for (float& value : result.rgb)
        value *= factor;
    return result;
}

std::string jsonText(const Report& report)
{
    const Metrics& m = report.metrics;
    nlohmann::ordered_json json;
    json["width"] = report.width;
    json["height"] = report.height;
    json["nonfinite_pixels"] = {{"reference", m.reference_nonfinite}, {"test", m.test_nonfinite}};
    json["mean_reference"] = m.reference_mean;
    json["mean_test"] = m.test_mean;
    json["mean_ratio"] = m.mean_ratio;
    json["rmse"] = m.rmse;
    json["relmse"] = m.relmse;
    json["relmse_trimmed"] = m.relmse_trimmed;
    json["mean_difference"] = m.mean_difference;
    json["bias_z"] = m.bias_z;
    json["hdr_flip"] = report.hdr.mean;
    json["hdr_flip_exposures"] = {
        {"start", report.exposures.start}, {"stop", report.exposures.stop}, {"count", report.exposures.count}};
    json["ldr_flip"] = report.ldr.mean;
    return json.dump(2) + "\n";
}

/// One line for scripts, see tools/compare/README.md.
std::string tsvText(const Report& report)
{
    const Metrics& m = report.metrics;
    return fmt::format("{:.6f}\t{:.6f}\t{:.6f}\t{:.6g}\t{:.6g}\t{:.6f}\t{:.6f}\t{}\t{:.6g}\t{:.6g}\n", m.mean_ratio[0],
                       m.mean_ratio[1], m.mean_ratio[2], m.relmse, m.relmse_trimmed, report.ldr.mean, report.hdr.mean,
                       m.test_nonfinite, m.bias_z, m.mean_difference);
}

std::string plainText(const Report& report)
{
    const Metrics& m = report.metrics;
    const auto rgb = [](const std::array<double, 3>& v)
    { return fmt::format("{:<11.6g} {:<11.6g} {:.6g}", v[0], v[1], v[2]); };
    return fmt::format("size            {} x {}\n"
                       "non-finite      {} reference, {} test pixels (taken as black)\n"
                       "mean reference  {}\n"
                       "mean test       {}\n"
                       "mean ratio      {}\n"
                       "mean difference {:.6g}\n"
                       "bias z          {:.2f}\n"
                       "RMSE            {:.6g}\n"
                       "relMSE          {:.6g} (trimmed of the worst 0.1 %: {:.6g})\n"
                       "HDR-FLIP        {:.6f} ({} exposures, {:.4f} to {:.4f})\n"
                       "LDR-FLIP        {:.6f}\n",
                       report.width, report.height, m.reference_nonfinite, m.test_nonfinite, rgb(m.reference_mean),
                       rgb(m.test_mean), rgb(m.mean_ratio), m.mean_difference, m.bias_z, m.rmse, m.relmse,
                       m.relmse_trimmed, report.hdr.mean, report.exposures.count, report.exposures.start,
                       report.exposures.stop, report.ldr.mean);
}

Report measure(ImageF& reference, ImageF& test, float scale)
{
    Report report{reference.width, reference.height, {}, {}, {}, {}};
    const uint64_t reference_nonfinite = blackenNonFinite(reference);
    const uint64_t test_nonfinite = blackenNonFinite(test);
    report.metrics = compareImages(reference, test);
    report.metrics.reference_nonfinite = reference_nonfinite;
    report.metrics.test_nonfinite = test_nonfinite;
    report.exposures = flipExposures(reference);
    report.hdr = hdrFlip(reference, test, report.exposures);
    // The display transform is scale, clamp, sRGB encode; LDR-FLIP starts by decoding sRGB, so the curve cancels.
    report.ldr = ldrFlip(scaled(reference, scale), scaled(test, scale));
    return report;
}

int run(const Options& options)
{
    std::vector<ImageF> images;
    if (const auto failed = readImages({options.reference, options.test}, options.crop, "reference", images))
        return *failed;
    ImageF &reference = images[0], &test = images[1];
    const float scale = std::exp2(options.exposure);
    const Report report = measure(reference, test, scale);
    if (!options.png.empty())
    {
        const Picture picture =
            sideBySide(reference, test, scale, options.flip_panel ? std::optional<FlipMap>(report.hdr) : std::nullopt);
        if (const Status written = writePng(options.png, picture.width, picture.height, 3, picture.rgb); !written)
            return fail(options.png, written.error());
    }
    fmt::print("{}", options.json ? jsonText(report) : options.tsv ? tsvText(report) : plainText(report));
    return int(ExitCode::kOk);
}

} // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app{"Measures the error of the rendering TEST against the rendering REFERENCE, or tests with --welch "
                 "whether two sets of "
                 "renderings differ by more than noise. All are linear OpenEXR images of one "
                 "size.\nExit codes: 0 done, 1 usage, 2 a file cannot be read or written, 3 not a matching image, "
                 "4 out of memory, 5 unsupported image.",
                 "lumicut-compare"};
    app.set_version_flag("--version", "lumicut-compare " LUMICUT_VERSION);
    addDocumentation(app);
    app.add_option("REFERENCE", options.reference, "the image taken as correct (.exr)");
    app.add_option("TEST", options.test, "the image to measure (.exr)");
    app.add_option("--png", options.png, "write reference, test and signed difference side by side (.png)");
    app.add_flag("--flip-map", options.flip_panel, "add the HDR-FLIP error map to the picture");
    app.add_option("--exposure", options.exposure, "stops of exposure for the picture and LDR-FLIP [0]")
        ->check(CLI::Range(-64.0, 64.0));
    app.add_option("--crop", options.crop, "use only pixels X0 <= x < X1, Y0 <= y < Y1 (X0,Y0,X1,Y1)")
        ->delimiter(',')
        ->expected(4);
    addWelchOptions(app, options.welch);
    int merged = int(ExitCode::kOk);
    addMergeCommand(app, merged);
    app.add_flag("--json", options.json, "print the result as JSON");
    app.add_flag("--tsv", options.tsv, "print one line of tab-separated figures (see tools/compare/README.md)")
        ->excludes("--json");
    try
    {
        app.parse(argc, argv);
        if (app.got_subcommand("merge"))
            return merged;
        if (!options.welch.asked() && (options.reference.empty() || options.test.empty()))
            throw CLI::RequiredError("REFERENCE and TEST, or --welch and --against,");
    }
    catch (const CLI::ParseError& problem)
    {
        return app.exit(problem) == 0 ? int(ExitCode::kOk) : int(ExitCode::kUsage);
    }
    if (options.welch.asked())
    {
        const Output output = options.json ? Output::kJson : options.tsv ? Output::kTsv : Output::kText;
        return runWelch(options.welch, options.crop, output);
    }
    return run(options);
}
