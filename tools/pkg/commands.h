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

/// Prints the contents of `package` to stdout.
ExitCode info(const std::filesystem::path& package, TextFormat format);

/// Prints nothing if all packages are valid, else one line on stderr for each invalid one. @return the highest exit code
ExitCode validate(const std::vector<std::filesystem::path>& packages);

/// Prints what differs between two packages: chunks by their hashes, counts, sizes, options.
/// @return as diff(1): 0 where they are the same, 1 where they differ, kDiffTrouble where one cannot be read
int diff(const std::filesystem::path& a, const std::filesystem::path& b, TextFormat format);
inline constexpr int kDiffTrouble = 2;

/// Writes one thing of `package` to `output`: "geometry" as .glb, "environment" as .exr, "texture/PAGE/LAYER" as .png, or
/// the raw bytes of a chunk ("NODE", "TEXP/1").
ExitCode extract(const std::filesystem::path& package, const std::string& what, const std::filesystem::path& output);

struct BundleOptions
{
    std::vector<std::filesystem::path> packages; // at least one; the first is what the launcher shows
    std::filesystem::path output;                // NAME.tar.zst, holds a folder NAME
    std::filesystem::path player;
};

/// Writes an archive with player, packages, launcher, libraries and licences: same input, same bytes.
ExitCode bundle(const BundleOptions& options);

/// A name from an untrusted file without control characters, for the terminal.
std::string printable(std::string string);

/// "file: error: text" on stderr.
inline ExitCode report(const std::filesystem::path& file, const Error& error)
{
    fmt::print(stderr, "{}: error: {}\n", file.string(), error.message);
    return error.code;
}
