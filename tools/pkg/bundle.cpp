#include "format/package_read.h"
#include "tools/pkg/archive.h"
#include "tools/pkg/bundle_texts.h"
#include "tools/pkg/commands.h"
#include "tools/pkg/licenses.h"
#include "tools/pkg/shared_libraries.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace
{
namespace fs = std::filesystem;

constexpr std::string_view kSuffix = ".tar.zst";

/// Letters, digits and a little punctuation: safe in a path, a shell script and an archive.
bool isPlainName(std::string_view name)
{
    const auto plain = [](char c)
    {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' ||
               c == '-';
    };
    return !name.empty() && name[0] != '.' && name[0] != '-' && std::all_of(name.begin(), name.end(), plain);
}

/// Adds packages/ and the credits that the packages carry.
Status addPackages(const std::vector<fs::path>& packages, ArchiveEntries& entries)
{
    std::string credits = "Credits of the scenes in packages/, as their source files state them.\n";
    for (const fs::path& path : packages)
    {
        const std::string name = path.filename().string();
        if (!isPlainName(name) || !name.ends_with(".lumi"))
            return Error{ExitCode::kUsage, fmt::format("{}: rename the package to plain letters, digits, '.', '_' and "
                                                       "'-' with the suffix .lumi",
                                                       path.string())};
        if (entries.contains("packages/" + name))
            return Error{ExitCode::kUsage, fmt::format("two packages are called {}; rename one", name)};
        const auto package = package::Package::open(path);
        if (!package)
            return Error{package.error().code, fmt::format("{}: {}", path.string(), package.error().message)};
        entries["packages/" + name] = {path, false};
        credits += "\n" + name + "\n";
        const auto* copyright = package->meta().provenance()->copyright();
        if (!copyright || copyright->size() == 0)
            credits += "  (none stated)\n";
        for (uint32_t i = 0; copyright && i < copyright->size(); ++i)
            credits += "  " + copyright->Get(i)->str() + "\n";
    }
    entries["LICENSES/scenes.txt"] = {credits, false};
    return Success{};
}

std::string launcher(const std::string& default_package)
{
    constexpr std::string_view kPlaceholder = "@DEFAULT_PACKAGE@";
    std::string text(kLauncherText);
    return text.replace(text.find(kPlaceholder), kPlaceholder.size(), default_package);
}

std::string readMe(const std::string& name, const std::vector<fs::path>& packages)
{
    std::string text = fmt::format("{}: scenes for the Lumicut player, version {}\n\n"
                                   "Start it with ./run.sh. The machine needs a Vulkan loader and a driver (Debian: "
                                   "libvulkan1 and\nmesa-vulkan-drivers); run.sh says which one is missing. Arguments "
                                   "go to the player: ./run.sh --help\n\nScenes:\n",
                                   name, LUMICUT_VERSION);
    for (const fs::path& path : packages)
        text += fmt::format("  ./run.sh packages/{}\n", path.filename().string());
    return text +
           "\nWhat each part may be used for is in LICENSES/. manifest.json lists every file with its SHA-256.\n";
}

Status addManifest(const std::string& name, ArchiveEntries& entries)
{
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    for (const auto& [path, entry] : entries)
    {
        const Result<Digest> d = digest(entry);
        if (!d)
            return d.error();
        files.push_back({{"path", path}, {"bytes", d->bytes}, {"sha256", d->sha256}});
    }
    const nlohmann::ordered_json manifest{{"name", name}, {"lumicut_version", LUMICUT_VERSION}, {"files", files}};
    entries["manifest.json"] = {manifest.dump(2) + "\n", false};
    return Success{};
}

Status addPlayer(const fs::path& player, ArchiveEntries& entries)
{
    std::error_code ignored;
    if (!fs::is_regular_file(player, ignored))
        return Error{ExitCode::kIo, "there is no player here; build it or name it with --player"};
    const auto libraries = librariesToBundle(player);
    if (!libraries)
        return libraries.error();
    entries["bin/lumicut-play"] = {player, true};
    for (const auto& [name, file] : *libraries)
        entries["lib/" + name] = {file, false};
    std::vector<std::string> unknown;
    addLicenses(*libraries, entries, unknown);
    for (const std::string& name : unknown)
        fmt::print(stderr, "{}: warning: no Debian package owns it, so its licence is not in the bundle; add it\n",
                   name);
    return Success{};
}
} // namespace

ExitCode bundle(const BundleOptions& options)
{
    const std::string file_name = options.output.filename().string();
    const std::string name = file_name.substr(0, file_name.size() - std::min(file_name.size(), kSuffix.size()));
    if (!file_name.ends_with(kSuffix) || !isPlainName(name))
        return report(options.output,
                      {ExitCode::kUsage, "the archive's name must be plain letters, digits, '.', '_' and "
                                         "'-' with the suffix .tar.zst"});
    ArchiveEntries entries;
    if (Status status = addPackages(options.packages, entries); !status)
        return report(options.output, status.error());
    if (Status status = addPlayer(options.player, entries); !status)
        return report(options.player, status.error());
    entries["run.sh"] = {launcher(options.packages[0].filename().string()), true};
    entries["README.txt"] = {readMe(name, options.packages), false};
    if (Status status = addManifest(name, entries); !status)
        return report(options.output, status.error());
    if (Status status = writeArchive(options.output, name, entries); !status)
        return report(options.output, status.error());
    return ExitCode::kOk;
}
