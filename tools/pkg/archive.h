// Reproducible archives: entries sorted, no times, no owners.
#pragma once
#include "format/result.h"

#include <filesystem>
#include <map>
#include <string>
#include <variant>

/// Where an entry's bytes come from: a file, or the text itself.
struct ArchiveEntry
{
    std::variant<std::filesystem::path, std::string> content;
    bool executable = false;
};
using ArchiveEntries = std::map<std::string, ArchiveEntry>; // by path inside the archive, folders are implied

struct Digest
{
    uint64_t bytes = 0;
    std::string sha256; // lower-case hexadecimal
};

/// @return kIo where a file cannot be read
Result<Digest> digest(const ArchiveEntry& entry);

/// Writes `entries` under the folder `root` as a zstd-compressed tar archive; all or nothing.
Status writeArchive(const std::filesystem::path& output, const std::string& root, const ArchiveEntries& entries);
