// The bytes behind the URIs of a glTF file.
#pragma once
#include "format/result.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Whether `uri` holds the data itself.
bool isDataUri(std::string_view uri);

/// The bytes behind a `uri` of the file: data in it or a file, relative to `folder`. Files are found by what exporters
/// write for them: percent-encoded or as they are, with backslashes for slashes, as file: URIs, with a query or
/// fragment behind the name, and last in another case.
/// @return kIo where there is no such file, kInvalid for data that is not base64, kUnsupported for what is elsewhere
Result<std::vector<unsigned char>> readUri(const std::string& uri, const std::filesystem::path& folder);

/// A whole regular file, or kIo with the system's reason.
Result<std::vector<unsigned char>> readFile(const std::filesystem::path& path);
