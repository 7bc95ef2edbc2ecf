#include "tools/pkg/commands.h"

#include "tools/cli/documentation.h"

namespace
{
/// The player as it is built and installed: beside this program.
std::filesystem::path defaultPlayer()
{
    std::error_code ignored;
    return std::filesystem::read_symlink("/proc/self/exe", ignored).replace_filename("lumicut-play");
}

struct Arguments
{
    std::filesystem::path file;
    TextFormat format = TextFormat::kText;
    std::vector<std::filesystem::path> files;
    std::filesystem::path other;
    std::string what;
    std::filesystem::path output;
    BundleOptions bundle{.packages = {}, .output = {}, .player = defaultPlayer()};
};

void declare(CLI::App& app, Arguments& arguments)
{
    app.require_subcommand(1);
    app.set_version_flag("--version", "lumicut-pkg " LUMICUT_VERSION);
    app.footer("Exit codes: 0 ok, 1 usage, 2 I/O, 3 invalid package, 4 out of memory, 5 unsupported; of diff 0 same,\n"
               "1 different, 2 trouble.");
    addDocumentation(app);

    const std::map<std::string, TextFormat> formats{{"text", TextFormat::kText}, {"json", TextFormat::kJson}};
    CLI::App* info_app = app.add_subcommand("info", "Print the contents of a package");
    info_app->add_option("FILE", arguments.file, "Package (.lumi)")->required();
    info_app->add_option("--format", arguments.format, "text or json")
        ->transform(CLI::CheckedTransformer(formats, CLI::ignore_case))
        ->default_str("text");

    CLI::App* validate_app = app.add_subcommand("validate", "Check packages; print nothing if all are valid");
    validate_app->add_option("FILE", arguments.files, "Packages (.lumi)")->required();

    CLI::App* diff_app = app.add_subcommand("diff", "Print the differences between two packages");
    diff_app->add_option("A", arguments.file, "Package (.lumi)")->required();
    diff_app->add_option("B", arguments.other, "Package (.lumi)")->required();
    diff_app->add_option("--format", arguments.format, "text or json")
        ->transform(CLI::CheckedTransformer(formats, CLI::ignore_case))
        ->default_str("text");

    CLI::App* extract_app = app.add_subcommand("extract", "Write one part of a package to a file");
    extract_app->add_option("FILE", arguments.file, "Package (.lumi)")->required();
    extract_app
        ->add_option(
            "WHAT", arguments.what,
            "geometry (.glb), environment (.exr), texture/PAGE/LAYER (.png), or a chunk's raw bytes: NODE, TEXP/1")
        ->required();
    extract_app->add_option("-o,--output", arguments.output, "File to write")->required();

    CLI::App* bundle_app = app.add_subcommand("bundle", "Pack player and packages into an archive that runs elsewhere");
    bundle_app->add_option("SCENE", arguments.bundle.packages, "Packages (.lumi); the first is the default")
        ->required();
    bundle_app->add_option("-o,--output", arguments.bundle.output, "Archive to write (NAME.tar.zst)")->required();
    bundle_app->add_option("--player", arguments.bundle.player, "Player to bundle")->capture_default_str();
}
} // namespace

int main(int argc, char** argv)
{
    CLI::App app("Inspects, checks and compares Lumicut packages, and bundles them with the player.", "lumicut-pkg");
    Arguments arguments;
    declare(app, arguments);
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        const bool diff_asked = argc > 1 && std::string_view(argv[1]) == "diff"; // its exit code 1 means "different"
        return app.exit(error) == 0 ? int(ExitCode::kOk) : diff_asked ? kDiffTrouble : int(ExitCode::kUsage);
    }
    if (app.got_subcommand("info"))
        return int(info(arguments.file, arguments.format));
    if (app.got_subcommand("validate"))
        return int(validate(arguments.files));
    if (app.got_subcommand("diff"))
        return diff(arguments.file, arguments.other, arguments.format);
    if (app.got_subcommand("extract"))
        return int(extract(arguments.file, arguments.what, arguments.output));
    return int(bundle(arguments.bundle));
}
