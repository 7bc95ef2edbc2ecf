// Which shared libraries a bundle must bring along.
#pragma once
#include "format/result.h"

#include <filesystem>
#include <map>
#include <string>

/// Library name (as the loader looks for it) to file, for everything `program` needs that a bare desktop lacks. C and
/// C++ run-time libraries, libvulkan, drivers and the X, Wayland and GL families stay the machine's own, and so does
/// whatever only they need.
Result<std::map<std::string, std::filesystem::path>> librariesToBundle(const std::filesystem::path& program);
