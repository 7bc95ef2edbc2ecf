#include "tools/pkg/licenses.h"

#include "tools/pkg/bundle_texts.h"
#include "tools/pkg/subprocess.h"

#include <algorithm>
#include <array>
#include <sstream>

namespace
{
namespace fs = std::filesystem;

// Header-only and static libraries that are part of the player itself.
constexpr std::array kCompiledIn{"libcli11-dev", "libflatbuffers-dev", "libimgui-dev", "libstb-dev",
                                 "libvulkan-volk-dev"};

/// On merged-/usr systems dpkg may know /usr/lib/x as /lib/x, or the other way round.
std::string otherName(const std::string& path)
{
    return path.starts_with("/usr/") ? path.substr(4) : "/usr" + path;
}

/// The Debian package that owns each of `files`, by path; files that none owns are left out.
std::map<std::string, std::string> packagesOf(const std::map<std::string, fs::path>& files)
{
    std::vector<std::string> query{"dpkg-query", "-S"};
    for (const auto& [name, file] : files)
    {
        query.push_back(file.string());
        query.push_back(otherName(file.string()));
    }
    std::map<std::string, std::string> packages;
    std::istringstream lines(outputOf(query));
    for (std::string line; std::getline(lines, line);) // "name:amd64: /path"
    {
        const size_t path = line.rfind(": /");
        if (path != std::string::npos && !line.starts_with("diversion"))
            packages[line.substr(path + 2)] = line.substr(0, line.find(':'));
    }
    return packages;
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
    const std::map<std::string, std::string> packages = packagesOf(libraries);
    for (const auto& [name, file] : libraries)
    {
        auto package = packages.find(file.string());
        if (package == packages.end())
            package = packages.find(otherName(file.string()));
        if (package == packages.end() || !addCopyright(package->second, entries))
            unknown.push_back(name);
    }
    for (const char* package : kCompiledIn)
        addCopyright(package, entries);
}
