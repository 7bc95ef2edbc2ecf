// The container of a package: header, chunk table, hashes, decompression; independent of the contents of chunks.
#pragma once
#include "format/package_layout.h"
#include "format/result.h"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace package
{
struct Container
{
    std::vector<ChunkEntry> table;
    std::vector<std::span<const std::byte>> chunks;    // [table.size()] raw bytes, at least 16-byte aligned
    std::vector<std::unique_ptr<std::byte[]>> storage; // [table.size()] of those that were compressed

    /// @return the chunk's raw bytes, empty where there is none
    std::span<const std::byte> find(uint32_t id, uint32_t index = 0) const;
};

enum class Unpack
{
    kAll,
    kMeta, // chunks other than META stay compressed, for readers that do without them
};

/// Verifies the container `file` (16-byte aligned; chunks of the result refer into it) and every chunk's hash.
Result<Container> readContainer(std::span<const std::byte> file, Unpack unpack = Unpack::kAll);
} // namespace package
