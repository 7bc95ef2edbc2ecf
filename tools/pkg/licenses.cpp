#include "tools/pkg/licenses.h"

#include "tools/pkg/bundle_texts.h"
#include "tools/pkg/subprocess.h"

#include <algorithm>
#include <array>
#include <optional>

namespace
{
namespace fs = std::filesystem;

// Header-only and static libraries that are part of the player itself.
constexpr std::array kCompiledIn{"libcli11-dev", "libflatbuffers-dev", "libimgui-dev", "libstb-dev",
                                 "libvulkan-volk-dev"};

/// The Debian package that owns `file`.
std::optional<std::string> packageOf(const fs::path& file)
{
    // On merged-/usr systems dpkg may know /usr/lib/x as /lib/x.
    std::string path = file.string();
    for (const std::string& candidate : {path, path.starts_with("/usr/") ? path.substr(4) : "/usr" + path})
    {
        const std::optional<std::string> line = outputOf({"dpkg-query", "-S", candidate}); // "name:amd64: /path"
        if (line && !line->starts_with("diversion"))
            return line->substr(0, line->find(':'));
    }
    return std::nullopt;
}

bool addCopyright(const std::string& package, ArchiveEntries& entries)
{
    std::error_code ignored;
    const fs::path file = fs::canonical(fs::path("/usr/share/doc") / package / "copyright", ignored);
    if (file.empty())
        return false;
    entries["LICENSES/" + package + ".txt"] = {file, false};
    return true;
}
} // namespace

void addLicenses(const std::map<std::string, fs::path>& libraries, ArchiveEntries& entries,
                 std::vector<std::string>& unknown)
{
    entries["LICENSES/lumicut-Apache-2.0.txt"] = {std::string(kLicenseText), false};
    for (const auto& [name, file] : libraries)
    {
        const std::optional<std::string> package = packageOf(file);
        if (!package || !addCopyright(*package, entries))
            unknown.push_back(name);
    }
    for (const char* package : kCompiledIn)
        addCopyright(package, entries);
}
