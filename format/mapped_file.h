// A whole file, mapped read-only.
#pragma once
#include "format/result.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace package
{
class MappedFile
{
public:
    MappedFile() = default;

    /// @return kIo where `path` cannot be opened or is no regular file, kInvalid where it is empty
    static Result<MappedFile> open(const std::filesystem::path& path);

    std::span<const std::byte> bytes() const { return bytes_; }

    MappedFile(MappedFile&& other) noexcept;
    MappedFile& operator=(MappedFile&& other) noexcept;
    ~MappedFile();

private:
    std::span<const std::byte> bytes_; // page-aligned
};
} // namespace package
