// The licence texts that a bundle must contain.
#pragma once
#include "tools/pkg/archive.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

/// Adds LICENSES/: the project's own, and the Debian copyright file of every library's package and of the libraries
/// compiled into the player. Libraries that no package owns are named in `unknown`.
void addLicenses(const std::map<std::string, std::filesystem::path>& libraries, ArchiveEntries& entries,
                 std::vector<std::string>& unknown);
