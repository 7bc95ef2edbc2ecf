// The files of one compilation: which ones were requested, and the hashes of their contents.
#pragma once
#include "compiler/content_hash.h"
#include "format/result.h"

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

struct InputFile
{
    std::string name;                     // as the scene names it: relative to its folder, or absolute
    std::optional<ContentHash> content{}; // none: it could not be read
};

class InputFiles
{
public:
    /// @param folder where relative names start
    explicit InputFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Reads a regular file and records its hash, or returns kIo with the system's reason and records it as missing.
    /// Thread-safe.
    Result<std::vector<unsigned char>> read(const std::string& name);

    /// By name, each once.
    std::vector<InputFile> list() const;

    const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
    mutable std::mutex mutex_;
    std::map<std::string, std::optional<ContentHash>> read_;
};

/// The hash of a file's present content; nothing if it cannot be read.
std::optional<ContentHash> contentOf(const std::filesystem::path& path);
