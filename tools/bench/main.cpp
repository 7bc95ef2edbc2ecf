// lumicut-bench: the command line.
#include <CLI/CLI.hpp> // before our check(), whose name its options use too

#include "tools/bench/primitives.h"
#include "tools/bench/rays.h"

#include <fmt/format.h>

int main(int argc, char** argv)
{
    CLI::App app{"Measures what this machine does: with Lumicut packages, and on its own.", "lumicut-bench"};
    app.set_version_flag("--version", "lumicut-bench " LUMICUT_VERSION);
    app.require_subcommand(1);
    RayBenchOptions options;
    std::string size = "1920x1080";
    CLI::App* rays = app.add_subcommand("rays", "ray throughput: primary, diffuse closest-hit, diffuse any-hit");
    rays->add_option("package", options.package, "the .lumi file")->required();
    rays->add_option("--size", size, "rays as a picture, WIDTHxHEIGHT")->capture_default_str();
    rays->add_option("--repeats", options.repeats, "timed runs of each kind")->check(CLI::Range(1, 1000))->capture_default_str();
    rays->add_option("--camera", options.camera, "camera by name or index; default the first");
    rays->add_option("--device", options.device, "index, part of a name, or cpu; default the best suitable one");
    rays->add_flag("--json", options.json, "print JSON");
    PrimitiveBenchOptions primitive_options;
    CLI::App* primitives = app.add_subcommand("primitives", "sort, scan, compaction, segmented reduction: GItems/s at several sizes");
    primitives->add_option("--items", primitive_options.items, "sizes, comma-separated")
        ->delimiter(',')
        ->check(CLI::Range(16, 1 << 26))
        ->capture_default_str();
    primitives->add_option("--repeats", primitive_options.repeats, "timed runs of each kind")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    primitives->add_option("--workers", primitive_options.workers, "who takes a share of the work")
        ->check(CLI::IsMember({"auto", "groups", "threads"}))
        ->capture_default_str();
    primitives->add_option("--device", primitive_options.device, "index, part of a name, or cpu; default the best suitable one");
    primitives->add_flag("--json", primitive_options.json, "print JSON");
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        return app.exit(error) == 0 ? int(ExitCode::kOk) : int(ExitCode::kUsage);
    }
    if (primitives->parsed())
    {
        const Status status = benchPrimitives(primitive_options);
        if (!status)
            fmt::print(stderr, "lumicut-bench: error: {}\n", status.error().message);
        return int(status ? ExitCode::kOk : status.error().code);
    }
    int used = 0;
    if (std::sscanf(size.c_str(), "%ux%u%n", &options.width, &options.height, &used) != 2 || size_t(used) != size.size() ||
        options.width < 1 || options.height < 1 || uint64_t(options.width) * options.height > 1u << 24)
    {
        fmt::print(stderr, "lumicut-bench: error: --size {}: WIDTHxHEIGHT is expected, at most 2^24 pixels\n", size);
        return int(ExitCode::kUsage);
    }
    const Status status = benchRays(options);
    if (status)
        return int(ExitCode::kOk);
    fmt::print(stderr, "{}: error: {}\n", options.package.string(), status.error().message);
    return int(status.error().code);
}
