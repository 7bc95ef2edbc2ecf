// Writes .lumi packages: deterministic bytes, all or nothing.
#pragma once
#include "format/package_layout.h"
#include "format/result.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace package
{
struct ChunkSource
{
    uint32_t id = 0;
    uint32_t index = 0;
    std::span<const std::byte> bytes; // borrowed until write() returns
};

struct WriteOptions
{
    int zstd_level = 0; // 0: no compression; else every bulk chunk that shrinks by 10 % or more is stored compressed
};

/// Size of one chunk as stored, for the compiler's summary.
struct WrittenChunk
{
    uint32_t id;
    uint32_t index;
    uint64_t stored_bytes;
    uint64_t raw_bytes;
};

/// Writes `chunks` (in any order, each id and index once, META among them; empty ones are left out) to `path` by way of a temporary file
/// beside it, fsync and rename: at no time is there a partial file under `path`, and on failure no temporary is left.
/// @return the table as written, or kIo with the system's reason
Result<std::vector<WrittenChunk>> write(const std::filesystem::path& path, std::span<const ChunkSource> chunks,
                                        const WriteOptions& options);
} // namespace package
