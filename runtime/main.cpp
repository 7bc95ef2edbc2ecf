// lumicut-play: the command line of the player.
#include "tools/cli/documentation.h" // before our check(), whose name its options use too

#include "image/write_image.h"
#include "runtime/capture.h"
#include "runtime/headless.h"
#include "runtime/opened_scene.h"
#include "runtime/reference_part.h"
#include "runtime/sequence.h"
#include "runtime/windowed.h"
#undef check

#include <algorithm>
#include <charconv>

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
        fmt::print("{}: {} ({}, {}, {} MiB)\n", device.index, device.name, device.kind, device.driver,
                   device.memory_bytes >> 20);
        for (const std::string& lack : device.lacks)
            fmt::print("   lacks {}\n", lack);
    }
    return int(ExitCode::kOk);
}

Status parseSize(const std::string& text, PlayerOptions& options)
{
    int used = 0;
    if (std::sscanf(text.c_str(), "%ux%u%n", &options.width, &options.height, &used) != 2 ||
        size_t(used) != text.size() || options.width < 1 || options.height < 1 || options.width > 8192 ||
        options.height > 8192)
        return Error{ExitCode::kUsage, fmt::format("--size {}: WIDTHxHEIGHT is expected, each 1 to 8192", text)};
    return Success{};
}

/// Refuses NaN, which CLI::Range() takes.
CLI::Validator between(double least, double most)
{
    const auto problem = [least, most](std::string& text)
    {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && value >= least && value <= most;
        return good ? std::string() : fmt::format("{} is no number from {} to {}", text, least, most);
    };
    return {problem, fmt::format("FLOAT in [{} - {}]", least, most)};
}

/// A number from `begin` to `end` of the text, all of it.
std::optional<uint32_t> numberIn(const std::string& text, size_t begin, size_t end)
{
    uint32_t value = 0;
    const auto [stop, error] = std::from_chars(text.data() + begin, text.data() + end, value);
    return error == std::errc() && stop == text.data() + end ? std::optional(value) : std::nullopt;
}

/// "A-B". @param what are numbered, for a sentence
Result<NumberRange> parseRange(const std::string& text, const std::string& option, const char* what, const char* wanted)
{
    constexpr uint32_t kMost = 9999999; // of a sequence: more files than that no folder should hold
    const size_t dash = text.find('-');
    const auto first = dash == std::string::npos ? std::nullopt : numberIn(text, 0, dash);
    const auto last = first ? numberIn(text, dash + 1, text.size()) : std::nullopt;
    if (!last || *last > kMost)
        return Error{ExitCode::kUsage, fmt::format("{}: '{}' is {}, up to {}", option, text, wanted, kMost)};
    if (*last < *first)
        return Error{ExitCode::kUsage, fmt::format("{}: the last {} of {} comes before the first", option, what, text)};
    return NumberRange{*first, *last};
}

/// "N", a count, or "A-B", of a sequence.
Status parseFrames(const std::string& text, PlayerOptions& options)
{
    if (const auto count = numberIn(text, 0, text.size()); count && *count > 0)
    {
        options.frame_count = *count;
        return Success{};
    }
    const auto range = parseRange(text, "--frames", "frame", "neither a count, 1 or more, nor a range such as 0-239");
    if (!range)
        return range.error();
    options.sequence = *range;
    return Success{};
}

Status parseSamples(const std::string& text, PlayerOptions& options)
{
    const auto range = parseRange(text, "--samples", "sample", "no range such as 0-63");
    if (!range)
        return range.error();
    options.samples = *range;
    if (!options.headless || options.mode != Mode::kReference || options.output.extension() != ".exr")
        return Error{ExitCode::kUsage, "--samples is of one picture: --headless --mode reference --output FILE.exr"};
    if (options.list_missing || options.sequence || options.frame_count > 0 || options.sample_count > 0)
        return Error{ExitCode::kUsage,
                     "--samples says how much to render; leave --frames, --spp and --list-missing out"};
    return Success{};
}

/// What belongs to paths and sequences. @param given of the options that sequences alone have, the first on the command line
Status checkSequence(const PlayerOptions& options, const std::string& given)
{
    const auto usage = [](std::string sentence) { return Error{ExitCode::kUsage, std::move(sentence)}; };
    if (!options.path.empty() && !options.camera.empty())
        return usage("--path and --camera both say where the camera is; give one");
    if (!options.sequence && !given.empty() && !(options.samples && given == "--force"))
        return usage(fmt::format("{} is for sequences: --headless --frames A-B", given));
    if (options.headless && !options.sequence && !options.path.empty())
        return usage("--path with --headless needs the frames to render: --frames A-B");
    if (!options.sequence)
        return Success{};
    if (!options.headless)
        return usage("a range of --frames is rendered with --headless; in a window --frames is a count");
    if (options.output.empty())
        return usage("a range of --frames needs files to go to: --output frame-%04d.exr or .png");
    const auto files = FrameFiles::parse(options.output);
    return files ? Status(Success{}) : files.error();
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
            return Error{ExitCode::kIo, fmt::format("there is no folder {} to write to", folder.string()),
                         path.string()};
        // What is there of a sequence or of --samples need not be written.
        const bool may_be_there = path == options.output && (options.sequence || options.samples);
        if (path.empty() || may_be_there || options.list_missing)
            continue;
        if (const Status status = canWriteFile(path); !status)
            return status.error().about(path.string());
    }
    if (options.frame_count > 0 && options.sample_count > 0)
        return Error{ExitCode::kUsage, "a count of --frames and --spp both say how much to render; give one"};
    const auto settings = makeSettings(options.preset.empty() ? "default" : options.preset, options.assignments);
    if (!settings)
        return settings.error();
    if (!options.layers.empty() && (!options.headless || options.output.extension() != ".exr" ||
                                    options.mode != Mode::kGi || settings->view != gpu::kViewNone))
        return Error{ExitCode::kUsage,
                     "--layers are of pictures of mode gi: --headless --output FILE.exr, and no view"};
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
    app.footer(
        "Settings (--set name=value):\n" + describeSettings() +
        "Exit codes: 0 ok, 1 usage, 2 I/O, 3 invalid package, 4 no suitable device or out of memory, 5 unsupported,\n"
        "75 the device was lost or its memory full: another try may succeed; 128 + N: signal N ended a sequence, "
        "whose\n"
        "frames so far are whole.");
    addDocumentation(app);
    PlayerOptions options;
    std::string size = "1280x720", frames, samples, mode = "gi", view;
    bool list_devices = false;
    app.add_option("package", options.package, "the .lumi file");
    app.add_flag("--headless", options.headless, "render without a window");
    app.add_option("--size", size, "picture size in pixels, WIDTHxHEIGHT")->capture_default_str();
    const CLI::Option* frames_option = app.add_option(
        "--frames", frames, "how many to render (headless default 1; in a window: no end), or A-B, a sequence");
    app.add_option("--spp", options.sample_count, "samples a pixel to render, of a sequence in each frame")
        ->check(CLI::Range(1u, UINT32_MAX));
    app.add_option("--samples", samples,
                   "of mode reference: samples A-B of every pixel alone, for lumicut-compare merge to add to others");
    app.add_option("--output", options.output,
                   "picture to write at the end: .exr (linear) or .png; of a sequence as frame-%04d.exr");
    app.add_option("--layers", options.layers,
                   "what an .exr of mode gi holds, a list with commas; default the picture alone")
        ->delimiter(',')
        ->allow_extra_args(false) // else it takes the package after it
        ->check(CLI::IsMember(std::vector<std::string>(kLayerNames.begin(), kLayerNames.end())));
    app.add_option("--path", options.path,
                   "camera path (.json) to follow; in a window until a key or the mouse moves the camera");
    const CLI::Option* sequence_options[] = {
        app.add_option("--fps", options.fps, "frames a second of the path and the animation, of a sequence")
            ->check(between(0.001, 1e6))
            ->capture_default_str(),
        app.add_option("--part", options.part,
                       "frames of a sequence of mode gi that go on from each other; --frames best begin at multiples")
            ->check(CLI::Range(1u, 10000000u))
            ->capture_default_str(),
        app.add_flag("--force", options.force, "render frames or --samples again that are there"),
        app.add_flag("--list-missing", options.list_missing,
                     "print the frames of a sequence that are not there, render nothing")};
    app.add_option("--mode", mode, "gi, direct or reference")
        ->check(CLI::IsMember({"gi", "direct", "reference"}))
        ->capture_default_str();
    app.add_option("--camera", options.camera, "camera by name or index; default the first");
    app.add_option("--animation", options.animation,
                   "what plays: a name, an index, all or none; default the first, of a single picture none");
    app.add_option("--time", options.seconds, "seconds of the animation that a picture shows or a sequence begins at")
        ->check(between(0, 1e6));
    app.add_option("--seed", options.seed, "seed of all random numbers")->capture_default_str();
    app.add_option("--device", options.device, "index, part of a name, or cpu; default the best suitable one");
    app.add_flag("--list-devices", list_devices, "list Vulkan devices and what each one lacks");
    app.add_option("--stats", options.stats, "write times and counts as JSON");
    app.add_option("--preset", options.preset,
                   "preview, default or high; without it preview on a CPU device, else default");
    app.add_option("--view", view, "show a stage of mode gi in place of the picture; the same as --set view=NAME");
    app.add_option("--against", options.against, "rendering (.exr) that --view error compares the picture with");
    app.add_option("--set", options.assignments, "change a setting, name=value; may be repeated")
        ->allow_extra_args(false); // else it takes the package after it
    app.add_flag("--validate", options.validation,
                 "run with the Vulkan validation layers; a message stops the program");
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
    if (status && frames_option->count() > 0)
        status = parseFrames(frames, options);
    if (status && !samples.empty())
        status = parseSamples(samples, options);
    const auto given =
        std::ranges::find_if(sequence_options, [](const CLI::Option* option) { return option->count() > 0; });
    if (status)
        status = checkSequence(options, given == std::end(sequence_options) ? "" : (*given)->get_name());
    if (status)
        status = checkOptions(options);
    if (!status)
        return fail("lumicut-play", status.error());
    status = options.sequence   ? playSequence(options)
             : options.samples  ? playReferencePart(options)
             : options.headless ? playHeadless(options)
                                : playWindowed(options);
    return status ? int(ExitCode::kOk) : fail(options.package.string(), status.error());
}
