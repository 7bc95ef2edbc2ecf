// The shared libraries that a bundle must contain.
#pragma once
#include "format/result.h"

#include <filesystem>
#include <map>
#include <string>

/// Library name (as the loader looks for it) to file, for everything `program` needs that a bare desktop lacks. C and
/// C++ run-time libraries, libvulkan, drivers and the X, Wayland and GL families are taken from the machine, and so are the
/// libraries that only they need.
Result<std::map<std::string, std::filesystem::path>> librariesToBundle(const std::filesystem::path& program);
