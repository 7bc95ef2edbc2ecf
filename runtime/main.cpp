// lumicut-play: the command line of the player.
#include "tools/cli/documentation.h" // before our check(), whose name its options use too

#include "runtime/capture.h"
#include "runtime/headless.h"
#include "runtime/opened_scene.h"
#include "runtime/windowed.h"
#undef check

namespace
{
int fail(const std::string& where, const Error& error)
{
    fmt::print(stderr, "{}: error: {}\n", error.file.empty() ? where : error.file, error.message);
    return int(error.code);
}

int listDevices(bool validation)
{
    const auto instance = Instance::create({.validation = validation});
    if (!instance)
        return fail("lumicut-play", instance.error());
    for (const DeviceInfo& device : instance->devices())
    {
        fmt::print("{}: {} ({}, {}, {} MiB)\n", device.index, device.name, device.kind, device.driver, device.memory_bytes >> 20);
        for (const std::string& lack : device.lacks)
            fmt::print("   lacks {}\n", lack);
    }
    return int(ExitCode::kOk);
}

Status parseSize(const std::string& text, PlayerOptions& options)
{
    int used = 0;
    if (std::sscanf(text.c_str(), "%ux%u%n", &options.width, &options.height, &used) != 2 || size_t(used) != text.size() ||
        options.width < 1 || options.height < 1 || options.width > 8192 || options.height > 8192)
        return Error{ExitCode::kUsage, fmt::format("--size {}: WIDTHxHEIGHT is expected, each 1 to 8192", text)};
    return Success{};
}

/// Checks that need no work.
Status checkOptions(const PlayerOptions& options)
{
    if (!options.output.empty())
        if (const Status status = checkPicturePath(options.output); !status)
            return status;
    for (const std::filesystem::path& path : {options.output, options.stats})
    {
        const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
        if (!std::filesystem::is_directory(folder))
            return Error{ExitCode::kIo, fmt::format("there is no folder {} to write to", folder.string()), path.string()};
    }
    if (options.frame_count > 0 && options.sample_count > 0)
        return Error{ExitCode::kUsage, "--frames and --spp both say how much to render; give one"};
    const auto settings = makeSettings(options.preset.empty() ? "default" : options.preset, options.assignments);
    if (!settings)
        return settings.error();
    if (options.mode != Mode::kGi && settings->view != gpu::kViewNone)
        return Error{ExitCode::kUsage, "views show the inside of mode gi; choose --mode gi or leave the view out"};
    if (settings->view == gpu::kViewError && options.against.empty())
        return Error{ExitCode::kUsage, std::string(kNothingToCompareWith)};
    if (options.headless && settings->view != gpu::kViewError && !options.against.empty())
        return Error{ExitCode::kUsage, "--against is for the view error; add --view error or leave it out"};
    return Success{};
}
} // namespace

int main(int argc, char** argv)
{
    CLI::App app{"Plays a .lumi package: a window with a fly camera, or pictures with --headless.", "lumicut-play"};
    app.set_version_flag("--version", "lumicut-play " LUMICUT_VERSION);
    app.footer("Settings (--set name=value):\n" + describeKnobs() +
               "Exit codes: 0 ok, 1 usage, 2 I/O, 3 invalid package, 4 no suitable device or out of memory, 5 unsupported.");
    addDocumentation(app);
    PlayerOptions options;
    std::string size = "1280x720", mode = "gi", view;
    bool list_devices = false;
    app.add_option("package", options.package, "the .lumi file");
    app.add_flag("--headless", options.headless, "render without a window");
    app.add_option("--size", size, "picture size in pixels, WIDTHxHEIGHT")->capture_default_str();
    app.add_option("--frames", options.frame_count, "frames to render (headless default 1; in a window: no end)")
        ->check(CLI::Range(1u, UINT32_MAX));
    app.add_option("--spp", options.sample_count, "samples a pixel to render")->check(CLI::Range(1u, UINT32_MAX));
    app.add_option("--output", options.output, "picture to write at the end: .exr (linear) or .png");
    app.add_option("--mode", mode, "gi, direct or reference")->check(CLI::IsMember({"gi", "direct", "reference"}))->capture_default_str();
    app.add_option("--camera", options.camera, "camera by name or index; default the first");
    app.add_option("--seed", options.seed, "seed of all random numbers")->capture_default_str();
    app.add_option("--device", options.device, "index, part of a name, or cpu; default the best suitable one");
    app.add_flag("--list-devices", list_devices, "list Vulkan devices and what each one lacks");
    app.add_option("--stats", options.stats, "write times and counts as JSON");
    app.add_option("--preset", options.preset, "preview, default or high; without it preview on a CPU device, else default");
    app.add_option("--view", view, "show a stage of mode gi in place of the picture; the same as --set view=NAME");
    app.add_option("--against", options.against, "rendering (.exr) that --view error compares the picture with");
    app.add_option("--set", options.assignments, "change a setting, name=value; may be repeated")
        ->allow_extra_args(false); // else it takes the package after it
    app.add_flag("--validate", options.validation, "run with the Vulkan validation layers; a message stops the program");
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        if (error.get_exit_code() == 0) // --help, --version
            return app.exit(error);
        return fail("lumicut-play", {ExitCode::kUsage, fmt::format("{} (see --help)", error.what())});
    }
    if (list_devices)
        return listDevices(options.validation);
    if (options.package.empty())
        return fail("lumicut-play", {ExitCode::kUsage, "a package is needed: lumicut-play scene.lumi (see --help)"});
    options.mode = mode == "gi" ? Mode::kGi : mode == "reference" ? Mode::kReference : Mode::kDirect;
    if (!view.empty())
        options.assignments.push_back("view=" + view);
    Status status = parseSize(size, options);
    if (status)
        status = checkOptions(options);
    if (!status)
        return fail("lumicut-play", status.error());
    status = options.headless ? playHeadless(options) : playWindowed(options);
    return status ? int(ExitCode::kOk) : fail(options.package.string(), status.error());
}
