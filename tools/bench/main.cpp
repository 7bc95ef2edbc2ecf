// lumicut-bench: the command line.
#include "tools/cli/documentation.h" // before our check(), whose name its options use too

#include "tools/bench/converge.h"
#include "tools/bench/frame.h"
#include "tools/bench/lookup.h"
#include "tools/bench/motion.h"
#include "tools/bench/primitives.h"
#include "tools/bench/rays.h"

#include <fmt/format.h>
#undef check

namespace
{
struct CommandLine
{
    RayBenchOptions rays;
    FrameBenchOptions frame;
    ConvergeBenchOptions converge;
    LookupBenchOptions lookup;
    MotionBenchOptions motion;
    PrimitiveBenchOptions primitives;
    std::string size = "1920x1080";
    std::string preset = "default";
    std::vector<std::string> assignments;
};

CLI::App* addPackageCommand(CLI::App& app, const char* name, const char* help, BenchOptions& options)
{
    CLI::App* command = app.add_subcommand(name, help);
    command->add_option("package", options.package, "the .lumi file")->required();
    command->add_option("--camera", options.camera, "camera by name or index; default the first");
    command->add_option("--device", options.device, "index, part of a name, or cpu; default the best suitable one");
    command->add_flag("--json", options.json, "print JSON");
    return command;
}

void addSize(CLI::App* command, CommandLine& line)
{
    command->add_option("--size", line.size, "picture size, WIDTHxHEIGHT")->capture_default_str();
}

void addSettings(CLI::App* command, CommandLine& line)
{
    command->add_option("--preset", line.preset, "preview, default or high")->capture_default_str();
    command->add_option("--set", line.assignments, "change a setting, name=value; may be repeated")
        ->allow_extra_args(false);
}

void addPackageCommands(CLI::App& app, CommandLine& line)
{
    CLI::App* rays =
        addPackageCommand(app, "rays", "ray throughput: primary, diffuse closest-hit, diffuse any-hit", line.rays);
    addSize(rays, line);
    rays->add_option("--repeats", line.rays.repeats, "timed runs of each kind")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();

    CLI::App* frame =
        addPackageCommand(app, "frame", "what a frame costs by stage, camera and light moving", line.frame);
    addSize(frame, line);
    addSettings(frame, line);
    frame->add_option("--mode", line.frame.mode, "what to render")
        ->check(CLI::IsMember({"gi", "direct", "reference"}))
        ->capture_default_str();
    frame->add_option("--frames", line.frame.frames, "timed frames")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    frame->add_option("--warm-up", line.frame.warm_up, "frames before them")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    frame->add_option("--animation", line.frame.animation,
                      "that plays meanwhile: a name, an index or all; default none");
    frame->add_option("--moving", line.frame.moving, "what moves from frame to frame")
        ->check(CLI::IsMember({"both", "camera", "lights", "nothing"}))
        ->capture_default_str();
    frame->add_flag("--kernels", line.frame.kernels, "print every dispatch of a frame, and the gaps between them");

    CLI::App* converge = addPackageCommand(
        app, "converge", "seconds and errors against a reference after 1, 2, 4, ... frames", line.converge);
    addSettings(converge, line);
    converge
        ->add_option("reference", line.converge.reference, "the picture taken as correct (.exr); its size is rendered")
        ->required();
    converge->add_option("--mode", line.converge.mode, "what to render")
        ->check(CLI::IsMember({"gi", "reference"}))
        ->capture_default_str();
    converge->add_option("--frames", line.converge.frames, "frames of a run")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    converge->add_option("--seeds", line.converge.seeds, "runs to average over")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    converge
        ->add_option("--travel", line.converge.travel,
                     "frames of a swaying camera before each run's first, which is as it comes to rest")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    converge->add_option("--output", line.converge.output, "write the last picture (.exr)");
    converge->add_flag("--stages", line.converge.stages, "print the stages' median times too");

    CLI::App* lookup = addPackageCommand(
        app, "lookup", "the illumination cut's lookups against full kNN and path tracing: time and error", line.lookup);
    addSize(lookup, line);
    addSettings(lookup, line);
    lookup->add_option("--repeats", line.lookup.repeats, "frames of each cut.mode")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    lookup
        ->add_option("--truth-rays", line.lookup.truth_rays,
                     "paths traced from each sample for its true irradiance; 0: none")
        ->check(CLI::Range(0, 1 << 20))
        ->capture_default_str();
}

void addMotion(CLI::App& app, CommandLine& line)
{
    MotionBenchOptions& options = line.motion;
    CLI::App* motion =
        addPackageCommand(app, "motion", "the picture while the camera moves: error, flicker, ghosts, times", options);
    addSize(motion, line);
    addSettings(motion, line);
    motion->add_option("--animation", options.animation, "that plays meanwhile: a name, an index or all; default none");
    motion->add_option("--path", options.path, "how the camera moves: sway, orbit, or a file with a camera path")
        ->capture_default_str();
    motion
        ->add_option("--lights", options.lights,
                     "how lights change: all pulse, or the strongest lamp does, takes on "
                     "colours or goes off, or one moves")
        ->check(CLI::IsMember(std::vector<std::string>(kLightChangeNames.begin(), kLightChangeNames.end())))
        ->capture_default_str();
    motion->add_option("--frames", options.frames, "measured frames")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    motion->add_option("--fps", options.frames_per_second, "frames a second of the path")
        ->check(CLI::Range(1e-3, 1e6))
        ->capture_default_str();
    motion->add_option("--warm-up", options.warm_up, "frames before them, on the same path")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    motion->add_option("--spp", options.sample_count, "samples a pixel of the references")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    motion->add_option("--mode", options.mode, "what to measure")
        ->check(CLI::IsMember({"gi", "direct", "reference"}))
        ->capture_default_str();
    motion->add_flag("--ghost,!--no-ghost", options.ghost,
                     "measure the light left after all lights are off, which doubles the time; default yes");
    motion->add_option("--seed", options.seed, "seed of all random numbers")->capture_default_str();
    motion->add_option("--cache", options.cache, "folder of cached references; default in the user's cache folder");
    motion->add_option("--dump", options.dump, "folder for each frame, its reference and its FLIP map (.png)");
}

void addPrimitives(CLI::App& app, PrimitiveBenchOptions& options)
{
    CLI::App* primitives =
        app.add_subcommand("primitives", "sort, scan, compaction, segmented reduction: GItems/s at several sizes");
    primitives->add_option("--items", options.items, "sizes, comma-separated")
        ->delimiter(',')
        ->check(CLI::Range(16, 1 << 26))
        ->capture_default_str();
    primitives->add_option("--repeats", options.repeats, "timed runs of each kind")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    primitives
        ->add_option("--workers", options.workers, "what processes a part of the work: workgroups or single threads")
        ->check(CLI::IsMember({"auto", "groups", "threads"}))
        ->capture_default_str();
    primitives->add_option("--device", options.device, "index, part of a name, or cpu; default the best suitable one");
    primitives->add_flag("--json", options.json, "print JSON");
}

/// Fills in what the command line gives as text.
Status readTexts(CommandLine& line)
{
    uint32_t width = 0, height = 0;
    int used = 0;
    if (std::sscanf(line.size.c_str(), "%ux%u%n", &width, &height, &used) != 2 || size_t(used) != line.size.size() ||
        width < 1 || height < 1 || uint64_t(width) * height > 1u << 24)
        return Error{ExitCode::kUsage,
                     fmt::format("--size {}: WIDTHxHEIGHT is expected, at most 2^24 pixels", line.size)};
    for (BenchOptions* options : {static_cast<BenchOptions*>(&line.rays), static_cast<BenchOptions*>(&line.frame),
                                  static_cast<BenchOptions*>(&line.lookup), static_cast<BenchOptions*>(&line.motion)})
    {
        options->width = width;
        options->height = height;
    }
    const auto settings = makeSettings(line.preset, line.assignments);
    if (!settings)
        return settings.error();
    line.frame.settings = line.converge.settings = line.lookup.settings = line.motion.settings = *settings;
    line.motion.preset = line.preset;
    return Success{};
}

int fail(const std::string& where, const Error& error)
{
    fmt::print(stderr, "{}: error: {}\n", error.file.empty() ? where : error.file, error.message);
    return int(error.code);
}
} // namespace

int main(int argc, char** argv)
{
    CLI::App app{"Measures what this machine does: with Lumicut packages, and on its own.", "lumicut-bench"};
    app.set_version_flag("--version", "lumicut-bench " LUMICUT_VERSION);
    app.require_subcommand(1);
    addDocumentation(app);
    CommandLine line;
    addPackageCommands(app, line);
    addMotion(app, line);
    addPrimitives(app, line.primitives);
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        return app.exit(error) == 0 ? int(ExitCode::kOk) : int(ExitCode::kUsage);
    }
    if (const Status status = readTexts(line); !status)
        return fail("lumicut-bench", status.error());
    const auto run = [](const Status& status, const std::filesystem::path& package)
    { return status ? int(ExitCode::kOk) : fail(package.string(), status.error()); };
    if (app.got_subcommand("frame"))
        return run(benchFrame(line.frame), line.frame.package);
    if (app.got_subcommand("converge"))
        return run(benchConverge(line.converge), line.converge.package);
    if (app.got_subcommand("lookup"))
        return run(benchLookup(line.lookup), line.lookup.package);
    if (app.got_subcommand("motion"))
        return run(benchMotion(line.motion), line.motion.package);
    if (app.got_subcommand("rays"))
        return run(benchRays(line.rays), line.rays.package);
    return run(benchPrimitives(line.primitives), "lumicut-bench");
}
