// lumicut-compile: the command line.
#include "compiler/camera_views.h"
#include "compiler/compile.h"
#include "compiler/linear.h"
#include "compiler/report.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>
#include <fstream>

namespace
{
struct Arguments
{
    std::string input;
    std::string output;
    std::string environment;
    std::string sun;
    std::vector<std::string> views;
    std::string report;
    std::string compress = "none";
    std::string default_light = "auto";
    bool strict = false;
    bool quiet = false;
};

int fail(const std::string& where, const Error& error)
{
    for (const std::string& detail : error.details)
        fmt::print(stderr, "{}: error: {}\n", where, detail);
    fmt::print(stderr, "{}: error: {}\n", error.file.empty() ? where : error.file, error.message);
    return int(error.code);
}

void declare(CLI::App& app, Arguments& a)
{
    app.add_option("scene", a.input, "Scene to compile (.gltf or .glb)")->required();
    app.add_option("-o,--output", a.output, "Package to write (default: the scene's name with .lumi)");
    app.add_option("--env", a.environment, "Environment: equirectangular .exr or .hdr, W/(m^2 sr)");
    app.add_option("--sun", a.sun, "Sun: DX,DY,DZ,LUX; the direction is the way its light travels");
    app.add_option(
           "--view", a.views,
           "Camera: NAME=EX,EY,EZ,TX,TY,TZ,YFOV; eye, target (metres), vertical field of view (degrees). Repeatable")
        ->allow_extra_args(false); // else it takes the scene after it
    app.add_option("--default-light", a.default_light,
                   "auto, on or off: a sky and a sun besides the scene's own light; auto: where that would leave the "
                   "picture black")
        ->check(CLI::IsMember({"auto", "on", "off"}))
        ->capture_default_str();
    app.add_flag_callback("--no-default-light",
                          [] { throw CLI::ValidationError("--no-default-light", "it is --default-light off now"); })
        ->group(""); // not listed
    app.add_flag("--strict", a.strict, "Treat damaged items of the scene as errors");
    app.add_option("--report", a.report, "Write what was made as JSON");
    app.add_option("--compress", a.compress, "none, zstd or zstd:LEVEL (1-19)")->capture_default_str();
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

/// Options that shape the package, in a fixed order; paths without folders.
std::vector<std::string> provenance(const Arguments& a)
{
    std::vector<std::string> text;
    if (!a.environment.empty())
        text.push_back("--env " + std::filesystem::path(a.environment).filename().string());
    if (!a.sun.empty())
        text.push_back("--sun " + a.sun);
    for (const std::string& view : a.views)
        text.push_back("--view " + view);
    if (a.default_light != "auto")
        text.push_back("--default-light " + a.default_light);
    if (a.compress != "none")
        text.push_back("--compress " + a.compress);
    return text;
}

Result<CompileOptions> toOptions(const Arguments& a)
{
    CompileOptions options;
    options.input = a.input;
    options.output =
        a.output.empty() ? std::filesystem::path(a.input).replace_extension(".lumi") : std::filesystem::path(a.output);
    options.default_light = a.default_light == "on"    ? DefaultLight::kOn
                            : a.default_light == "off" ? DefaultLight::kOff
                                                       : DefaultLight::kAuto;
    options.strict = a.strict;
    options.text = provenance(a);
    if (!a.environment.empty())
        options.environment = a.environment;
    const Result<int> level = parseCompression(a.compress);
    if (!level)
        return level.error();
    options.zstd_level = *level;
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
    if (!a.quiet)
        options.progress = [](double seconds, const std::string& line)
        { fmt::print(stderr, "[{:5.2f} s] {}\n", seconds, line); };
    return options;
}

Status writeReport(const std::string& path, const std::string& json)
{
    std::ofstream stream(path, std::ios::binary);
    if (!(stream << json << std::flush))
        return Error{ExitCode::kIo, "the report cannot be written"};
    return Success{};
}
} // namespace

int main(int argc, char** argv)
{
    CLI::App app{"Compiles a glTF scene into a package for lumicut-play.", "lumicut-compile"};
    app.footer("Exit codes: 0 ok, 1 usage, 2 I/O, 3 invalid scene, 4 out of memory, 5 unsupported.");
    Arguments arguments;
    declare(app, arguments);
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& e)
    {
        if (e.get_exit_code() == 0) // --help, --version
            return app.exit(e);
        return fail("lumicut-compile", {ExitCode::kUsage, fmt::format("{} (see --help)", e.what())});
    }
    const Result<CompileOptions> options = toOptions(arguments);
    if (!options)
        return fail("lumicut-compile", options.error());
    if (!arguments.report.empty())
        if (const Status status = checkWritable(arguments.report); !status)
            return fail(arguments.report, status.error());
    const Result<CompileReport> report = compile(*options);
    if (!report)
        return fail(arguments.input, report.error());
    if (!arguments.quiet)
    {
        for (const std::string& warning : report->meta.provenance->warnings)
            fmt::print(stderr, "{}: warning: {}\n", arguments.input, warning);
        fmt::print("{}", summaryText(*report, *options));
    }
    if (!arguments.report.empty())
        if (const Status status = writeReport(arguments.report, reportJson(*report, *options)); !status)
            return fail(arguments.report, status.error());
    return int(ExitCode::kOk);
}
