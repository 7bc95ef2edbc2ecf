// The verbs of lumicut-pkg. Each prints its own diagnostics and returns the exit code.
#pragma once
#include "format/result.h"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

enum class TextFormat
{
    kText,
    kJson,
};

/// Prints what `package` holds to stdout.
ExitCode info(const std::filesystem::path& package, TextFormat format);

/// Silent where all packages are valid, else one line on stderr for each that is not; the highest exit code wins.
ExitCode validate(const std::vector<std::filesystem::path>& packages);

struct BundleOptions
{
    std::vector<std::filesystem::path> packages; // at least one; the first is what the launcher shows
    std::filesystem::path output;                // NAME.tar.zst, holds a folder NAME
    std::filesystem::path player;
};

/// Writes an archive with player, packages, launcher, libraries and licences: same input, same bytes.
ExitCode bundle(const BundleOptions& options);

/// "file: error: text" on stderr.
inline ExitCode report(const std::filesystem::path& file, const Error& error)
{
    fmt::print(stderr, "{}: error: {}\n", file.string(), error.message);
    return error.code;
}
