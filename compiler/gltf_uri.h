// The bytes behind the URIs of a glTF file.
#pragma once
#include "compiler/input_files.h"
#include "format/result.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Whether `uri` holds the data itself.
bool isDataUri(std::string_view uri);

/// The bytes behind a `uri` of the file: data in it or one of `files`. Files are found by what exporters
/// write for them: percent-encoded or as they are, with backslashes for slashes, as file: URIs, with a query or
/// fragment behind the name, and last in another case.
/// @return kIo where there is no such file, kInvalid for data that is not base64, kUnsupported for what is elsewhere
Result<std::vector<unsigned char>> readUri(const std::string& uri, InputFiles& files);

/// `message` with paths below `folder` relative to it, so that what is kept does not depend on where the scene lies.
std::string withoutFolder(std::string message, const std::filesystem::path& folder);

/// A whole regular file, or kIo with the system's reason.
Result<std::vector<unsigned char>> readFile(const std::filesystem::path& path);
