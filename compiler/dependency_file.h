// What a package was made from, for make and ninja.
#pragma once
#include "format/result.h"

#include <filesystem>
#include <vector>

/// A make rule "output: inputs", and an empty rule for each input, so that make does not stop if one is gone.
/// Escaped as GCC does, which make and ninja read alike. @return kUsage for names that neither can hold (line breaks)
Result<std::string> dependencyRule(const std::filesystem::path& output,
                                   const std::vector<std::filesystem::path>& inputs);
