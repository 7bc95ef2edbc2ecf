// The files of one compilation: which ones were asked for, and what they held.
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

    /// A whole regular file, noted down with what it holds, or kIo with the system's reason, noted down as missing.
    /// From any thread.
    Result<std::vector<unsigned char>> read(const std::string& name);

    /// By name, each once.
    std::vector<InputFile> list() const;

    const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
    mutable std::mutex mutex_;
    std::map<std::string, std::optional<ContentHash>> read_;
};

/// What a file holds now; nothing where it cannot be read.
std::optional<ContentHash> contentOf(const std::filesystem::path& path);
