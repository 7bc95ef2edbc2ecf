// lumicut-compile: the command line.
#include "compiler/camera_views.h"
#include "compiler/compile_many.h"
#include "compiler/gltf_list.h"
#include "compiler/linear.h"
#include "compiler/parallel.h"
#include "format/temporary_file.h"
#include "tools/cli/documentation.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace
{
struct Arguments
{
    std::vector<std::string> scenes;
    std::string output;
    std::string scene;
    std::string variant;
    std::string time;
    std::string animation;
    std::string environment;
    std::string environment_rotation;
    std::string environment_scale;
    std::string sun;
    std::vector<std::string> views;
    std::string report;
    std::string compress = "none";
    std::string textures = "bc";
    std::string dependencies;
    std::string cache;
    uint64_t cache_bytes = uint64_t(4) << 30;
    unsigned threads = thread_limit;
    bool force = false;
    std::string default_light = "auto";
    bool strict = false;
    bool quiet = false;
    bool list = false;
    bool json = false;
};

void declare(CLI::App& app, Arguments& a)
{
    app.add_option("scene", a.scenes, "Scenes to compile (.gltf or .glb)")->required();
    app.add_option("-o,--output", a.output,
                   "Package to write, or the folder for it (default: beside the scene, with .lumi)");
    app.add_option("--scene", a.scene, "Scene of the file, name or index (default: the file's default)");
    app.add_option("--variant", a.variant, "Variant of the file's materials (KHR_materials_variants)");
    auto* time = app.add_option("--time", a.time,
                                "Compile the pose at this time in seconds, instead of what moves (default: the package "
                                "carries the animations)");
    app.add_option("--animation", a.animation, "Of --time: name or index, or all at once (default: the first)")
        ->needs(time);
    auto* env = app.add_option("--env", a.environment, "Environment: equirectangular .exr or .hdr, W/(m^2 sr)");
    app.add_option("--env-rotate", a.environment_rotation,
                   "Rotation of the environment about +Y in degrees, counter-clockwise seen from above")
        ->needs(env);
    app.add_option("--env-scale", a.environment_scale, "Factor for the environment's radiance")->needs(env);
    app.add_option("--sun", a.sun, "Directional light: DX,DY,DZ,LUX; the direction is the one its light travels in");
    app.add_option(
           "--view", a.views,
           "Camera: NAME=EX,EY,EZ,TX,TY,TZ,YFOV; eye, target (metres), vertical field of view (degrees). Repeatable")
        ->allow_extra_args(false); // otherwise it would take the scene after it
    app.add_option("--default-light", a.default_light,
                   "auto, on or off: add a sky and a sun to the scene's own light; auto: if the picture would be black "
                   "without them")
        ->check(CLI::IsMember({"auto", "on", "off"}))
        ->capture_default_str();
    app.add_flag_callback("--no-default-light",
                          [] { throw CLI::ValidationError("--no-default-light", "it is --default-light off now"); })
        ->group(""); // not listed
    app.add_flag("--strict", a.strict, "Treat damaged items of the scene as errors");
    app.add_option("--report", a.report, "Write a report as JSON; for several scenes, into this folder");
    app.add_option("--compress", a.compress, "none, zstd or zstd:LEVEL (1-19)")->capture_default_str();
    app.add_option("--textures", a.textures, "bc: block-compressed (BC7, BC5, BC4); raw: RGBA8")
        ->check(CLI::IsMember({"bc", "raw"}))
        ->capture_default_str();
    CLI::Option* list = app.add_flag("--list", a.list,
                                     "Print the scenes, variants, cameras, animations, skins, lights "
                                     "and materials of the file, and compile nothing");
    app.add_flag("--json", a.json, "With --list: print JSON")->needs(list);
    app.add_option("--deps", a.dependencies, "Write the files that the packages depend on, for make and ninja");
    app.add_option("--cache", a.cache, "Folder of cached results for the next run");
    app.add_option("--cache-size", a.cache_bytes, "Size to which the folder is trimmed (k, m, g, ...)")
        ->transform(CLI::AsSizeValue(false))
        ->default_str("4g");
    app.add_option("-j,--jobs", a.threads, "Total number of threads (default: as many as cores)")
        ->check(CLI::Range(1, 1024));
    app.add_flag("-f,--force", a.force, "Compile up-to-date packages, too");
    app.add_flag("-q,--quiet", a.quiet, "Print errors only");
    app.set_version_flag("--version", "lumicut-compile " LUMICUT_VERSION);
}

Result<int> parseCompression(const std::string& text)
{
    constexpr int kDefaultLevel = 3;
    if (text == "none")
        return 0;
    if (text == "zstd")
        return kDefaultLevel;
    int level = 0;
    const std::string_view digits = text.starts_with("zstd:") ? std::string_view(text).substr(5) : "";
    const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), level);
    if (failure != std::errc() || end != digits.data() + digits.size() || level < 1 || level > 19)
        return Error{ExitCode::kUsage,
                     fmt::format("--compress \"{}\" is not none, zstd or zstd:LEVEL with a level of 1 to 19", text)};
    return level;
}

Result<PunctualLight> parseSun(const std::string& text)
{
    const Result<std::vector<double>> n = parseNumbers(text, 4);
    if (!n)
        return Error{ExitCode::kUsage, fmt::format("--sun: {} (DX,DY,DZ,LUX)", n.error().message)};
    const Vec3d direction{(*n)[0], (*n)[1], (*n)[2]};
    const auto lux = float((*n)[3]);
    if (direction == Vec3d{} || !(lux > 0) || !std::isfinite(lux))
        return Error{ExitCode::kUsage, fmt::format("--sun \"{}\" needs a direction and a positive illuminance", text)};
    PunctualLight sun;
    sun.kind = gpu::kLightDirectional;
    sun.direction = directionOr(direction, {0, -1, 0});
    sun.intensity = {lux, lux, lux};
    return sun;
}

Status parseEnvironment(const Arguments& a, CompileOptions& options)
{
    if (!a.environment.empty())
        options.environment = a.environment;
    if (!a.environment_rotation.empty())
    {
        const Result<std::vector<double>> degrees = parseNumbers(a.environment_rotation, 1);
        if (!degrees)
            return Error{ExitCode::kUsage, fmt::format("--env-rotate: {} (DEGREES)", degrees.error().message)};
        options.environment_rotation = float(std::remainder(degrees->front(), 360.0) * std::numbers::pi / 180);
    }
    if (!a.environment_scale.empty())
    {
        const Result<std::vector<double>> factor = parseNumbers(a.environment_scale, 1);
        if (!factor)
            return Error{ExitCode::kUsage, fmt::format("--env-scale: {} (FACTOR)", factor.error().message)};
        options.environment_scale = float(factor->front());
        if (!(options.environment_scale > 0) || !std::isfinite(options.environment_scale))
            return Error{ExitCode::kUsage,
                         fmt::format("--env-scale \"{}\" is not a positive number", a.environment_scale)};
    }
    return Success{};
}

/// Options that shape the package, in the order of their declaration; paths without folders.
std::vector<std::string> provenance(const CLI::App& app)
{
    static const std::set<std::string> kLeaveItAsItIs{"--help",  "--version",    "--output", "--report", "--deps",
                                                      "--cache", "--cache-size", "--jobs",   "--force",  "--quiet"};
    static const std::set<std::string> kPaths{"--env"};
    std::vector<std::string> text;
    for (const CLI::Option* option : app.get_options())
    {
        const std::string name = option->get_name();
        if (option->count() == 0 || option->get_positional() || kLeaveItAsItIs.contains(name))
            continue;
        if (option->get_items_expected() == 0)
            text.push_back(name);
        else
            for (const std::string& value : option->results())
                if (value != option->get_default_str())
                    text.push_back(name + " " +
                                   (kPaths.contains(name) ? std::filesystem::path(value).filename().string() : value));
    }
    return text;
}

/// The options that all scenes share.
Result<CompileOptions> toOptions(const CLI::App& app, const Arguments& a)
{
    CompileOptions options;
    options.default_light = a.default_light == "on"    ? DefaultLight::kOn
                            : a.default_light == "off" ? DefaultLight::kOff
                                                       : DefaultLight::kAuto;
    options.strict = a.strict;
    options.text = provenance(app);
    if (const Status status = parseEnvironment(a, options); !status)
        return status.error();
    options.scene = a.scene;
    options.variant = a.variant;
    if (!a.time.empty())
    {
        const Result<std::vector<double>> seconds = parseNumbers(a.time, 1);
        if (!seconds)
            return Error{ExitCode::kUsage, fmt::format("--time: {} (SECONDS)", seconds.error().message)};
        if (!(seconds->front() >= 0) || !std::isfinite(seconds->front()))
            return Error{ExitCode::kUsage, fmt::format("--time \"{}\" is not a time of 0 s or more", a.time)};
        options.time = BakedTime{seconds->front(), a.animation};
    }
    const Result<int> level = parseCompression(a.compress);
    if (!level)
        return level.error();
    options.zstd_level = *level;
    options.textures = a.textures == "raw" ? TextureCompression::kRaw : TextureCompression::kBlocks;
    if (!a.sun.empty())
    {
        const Result<PunctualLight> sun = parseSun(a.sun);
        if (!sun)
            return sun.error();
        options.sun = *sun;
    }
    for (const std::string& text : a.views)
    {
        Result<CameraView> view = parseView(text);
        if (!view)
            return view.error();
        options.views.push_back(std::move(*view));
    }
    return options;
}

/// Of each scene in turn. @return the first error
int printLists(const Arguments& a)
{
    ExitCode code = ExitCode::kOk;
    for (const std::string& scene : a.scenes)
    {
        const auto groups = listGltf(scene);
        if (groups)
            fmt::print("{}", a.json ? listJson(*groups, scene) : listText(*groups));
        else if (const ExitCode failed = reportError(scene, groups.error()); code == ExitCode::kOk)
            code = failed;
    }
    return int(code);
}

/// Where what is made of `scene` goes: `given` itself, or into it where it is a folder or there are several scenes.
Result<std::filesystem::path> placeFor(const std::filesystem::path& scene, const std::string& given, const char* suffix,
                                       bool several)
{
    namespace fs = std::filesystem;
    std::error_code problem;
    if (!several && !given.ends_with('/') && !fs::is_directory(given, problem))
        return fs::path(given);
    if (fs::exists(given, problem) && !fs::is_directory(given, problem))
        return Error{ExitCode::kUsage, "it is a file; several scenes need a folder", given};
    if (several && !given.ends_with('/') && fs::path(given).extension() == suffix)
        return Error{ExitCode::kUsage, fmt::format("several scenes need a folder; a folder of this name ends in /"),
                     given};
    fs::create_directories(given, problem);
    if (problem)
        return Error{ExitCode::kIo, fmt::format("the folder cannot be made: {}", problem.message()), given};
    return fs::path(given) / scene.filename().replace_extension(suffix);
}

Result<CompileManyOptions> toJobs(const CLI::App& app, const Arguments& a)
{
    const Result<CompileOptions> shared = toOptions(app, a);
    if (!shared)
        return shared.error();
    CompileManyOptions many{.jobs = {},
                            .threads = a.threads,
                            .force = a.force,
                            .quiet = a.quiet,
                            .cache_folder = {},
                            .cache_bytes = a.cache_bytes,
                            .dependency_file = {}};
    const bool several = a.scenes.size() > 1;
    std::map<std::filesystem::path, std::string> taken; // by output
    for (const std::string& scene : a.scenes)
    {
        CompileJob& job = many.jobs.emplace_back(CompileJob{*shared, {}});
        job.options.input = scene;
        job.options.output = std::filesystem::path(scene).replace_extension(".lumi");
        if (!a.output.empty())
        {
            const auto place = placeFor(scene, a.output, ".lumi", several);
            if (!place)
                return place.error();
            job.options.output = *place;
        }
        if (const auto [other, is_new] = taken.try_emplace(job.options.output.lexically_normal(), scene); !is_new)
            return Error{ExitCode::kUsage,
                         fmt::format("its package would be the same file as that of \"{}\": {}", other->second,
                                     job.options.output.string()),
                         scene};
        if (a.report.empty())
            continue;
        const auto place = placeFor(scene, a.report, ".json", several);
        if (!place)
            return place.error();
        if (const Status status = checkWritable(*place); !status)
            return status.error().about(place->string());
        job.report = *place;
    }
    if (!a.cache.empty())
        many.cache_folder = a.cache;
    if (!a.dependencies.empty())
    {
        if (const Status status = checkWritable(a.dependencies); !status)
            return status.error().about(a.dependencies);
        many.dependency_file = a.dependencies;
    }
    return many;
}
} // namespace

int main(int argc, char** argv)
{
    CLI::App app{"Compiles glTF scenes into packages for lumicut-play.", "lumicut-compile"};
    app.footer(
        "Exit codes: 0 ok, 1 usage, 2 I/O, 3 invalid scene, 4 out of memory, 5 unsupported; of several scenes the\n"
        "first that fails decides, and the others are compiled.");
    Arguments arguments;
    declare(app, arguments);
    addDocumentation(app);
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& e)
    {
        if (e.get_exit_code() == 0) // --help, --version
            return app.exit(e);
        return int(reportError("lumicut-compile", {ExitCode::kUsage, fmt::format("{} (see --help)", e.what())}));
    }
    if (arguments.list)
        return printLists(arguments);
    const Result<CompileManyOptions> jobs = toJobs(app, arguments);
    if (!jobs)
        return int(reportError("lumicut-compile", jobs.error()));
    removeTemporaryFilesOnSignals();
    return int(compileMany(*jobs));
}
