// Images of the command line, read and cut to one size.
#pragma once
#include "format/result.h"
#include "image/image.h"

#include <optional>
#include <string>

/// Prints the error as a message about `file`. @return the exit code
int fail(const std::string& file, const Error& error);

/// Reads images that all must have the size of the first, and crops them. Errors are printed on stderr.
/// @param crop X0, Y0, X1, Y1, the last two exclusive, or empty
/// @param first_name what a message calls the first image
/// @return nothing, or the exit code
std::optional<int> readImages(const std::vector<std::string>& files, const std::vector<uint32_t>& crop,
                              const std::string& first_name, std::vector<ImageF>& images);
