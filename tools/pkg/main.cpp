#include "tools/pkg/commands.h"

#include <CLI/CLI.hpp>

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
    BundleOptions bundle{.packages = {}, .output = {}, .player = defaultPlayer()};
};

void declare(CLI::App& app, Arguments& arguments)
{
    app.require_subcommand(1);
    app.set_version_flag("--version", LUMICUT_VERSION);

    const std::map<std::string, TextFormat> formats{{"text", TextFormat::kText}, {"json", TextFormat::kJson}};
    CLI::App* info_app = app.add_subcommand("info", "Print what a package holds");
    info_app->add_option("FILE", arguments.file, "Package (.lumi)")->required();
    info_app->add_option("--format", arguments.format, "text or json")
        ->transform(CLI::CheckedTransformer(formats, CLI::ignore_case))
        ->default_str("text");

    CLI::App* validate_app = app.add_subcommand("validate", "Check packages; silent where all is well");
    validate_app->add_option("FILE", arguments.files, "Packages (.lumi)")->required();

    CLI::App* bundle_app = app.add_subcommand("bundle", "Pack player and packages into an archive that runs elsewhere");
    bundle_app->add_option("SCENE", arguments.bundle.packages, "Packages (.lumi); the first is the default")
        ->required();
    bundle_app->add_option("-o,--output", arguments.bundle.output, "Archive to write (NAME.tar.zst)")->required();
    bundle_app->add_option("--player", arguments.bundle.player, "Player to bundle")->capture_default_str();
}
} // namespace

int main(int argc, char** argv)
{
    CLI::App app("Looks into Lumicut packages, checks them, and bundles them with the player.", "lumicut-pkg");
    Arguments arguments;
    declare(app, arguments);
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        return int(app.exit(error) == 0 ? ExitCode::kOk : ExitCode::kUsage);
    }
    if (app.got_subcommand("info"))
        return int(info(arguments.file, arguments.format));
    if (app.got_subcommand("validate"))
        return int(validate(arguments.files));
    return int(bundle(arguments.bundle));
}
