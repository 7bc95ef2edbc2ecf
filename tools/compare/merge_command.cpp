#include "tools/compare/merge_command.h"

#include "image/sample_sum.h"
#include "tools/compare/read_images.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>

namespace
{
struct MergeOptions
{
    std::vector<std::string> parts;
    std::string output;
};

int merge(const MergeOptions& options)
{
    std::optional<SampleSum> sum;
    for (const std::string& file : options.parts) // one at a time: a part takes as much memory as the sum
    {
        auto part = readSampleSum(file);
        if (!part)
            return fail(file, part.error());
        if (!sum)
            sum = std::move(*part);
        else if (const Status status = addSamples(*sum, *part); !status)
            return fail(file, status.error());
    }
    if (const Status status = writeSampleSum(options.output, *sum); !status)
        return fail(options.output, status.error());
    fmt::print("{} samples a pixel: {}\n", sum->sampleCount(), samplesText(sum->samples));
    return int(ExitCode::kOk);
}
} // namespace

void addMergeCommand(CLI::App& app, int& exit_code)
{
    CLI::App* command = app.add_subcommand("merge", "Adds up parts of a reference, rendered with --samples");
    const auto options = std::make_shared<MergeOptions>();
    command->add_option("PART", options->parts, "pictures of lumicut-play --mode reference --samples A-B (.exr)")
        ->required();
    command->add_option("-o,--output", options->output, "picture to write (.exr); its bytes do not depend on the parts")
        ->required();
    command->callback([options, &exit_code] { exit_code = merge(*options); });
}
