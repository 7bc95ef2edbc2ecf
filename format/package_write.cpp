#include "format/package_write.h"

#include "format/check.h"
#include "format/temporary_file.h"

#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

namespace package
{
namespace
{
/// A chunk on its way into the file: its table entry and the bytes to store.
struct Pending
{
    ChunkEntry entry{};
    std::span<const std::byte> stored;
    std::vector<std::byte> compressed; // what `stored` refers to where a codec is used
};

uint64_t alignUp(uint64_t offset, uint64_t alignment)
{
    return (offset + alignment - 1) / alignment * alignment;
}

/// @return the zstd frame, or nothing where it would not pay or would break the reader's expansion limit
std::vector<std::byte> compress(std::span<const std::byte> raw, int level)
{
    std::vector<std::byte> frame(ZSTD_compressBound(raw.size()));
    const size_t size = ZSTD_compress(frame.data(), frame.size(), raw.data(), raw.size(), level);
    check(!ZSTD_isError(size), "zstd: {}", ZSTD_getErrorName(size));
    if (size > raw.size() / 10 * 9 || raw.size() > size * kMaxExpansion)
        return {};
    frame.resize(size);
    return frame;
}

std::vector<Pending> prepare(std::span<const ChunkSource> chunks, const WriteOptions& options)
{
    std::vector<Pending> pending;
    for (const ChunkSource& chunk : chunks)
    {
        if (chunk.bytes.empty())
            continue;
        Pending& p = pending.emplace_back();
        const bool bulk = chunk.id != kMetaChunk;
        if (bulk && options.zstd_level != 0)
            p.compressed = compress(chunk.bytes, options.zstd_level);
        const bool packed = !p.compressed.empty();
        p.stored = packed ? std::span<const std::byte>(p.compressed) : chunk.bytes;
        p.entry = {.id = chunk.id,
                   .index = chunk.index,
                   .required = isRequired(chunk.id),
                   .codec = packed ? Codec::kZstd : Codec::kNone,
                   .alignment = bulk && !packed ? kBulkAlignment : kSmallAlignment,
                   .reserved = 0,
                   .offset = 0,
                   .stored_bytes = p.stored.size(),
                   .raw_bytes = chunk.bytes.size(),
                   .hash = XXH3_64bits(p.stored.data(), p.stored.size())};
    }
    std::sort(pending.begin(), pending.end(),
              [](const Pending& a, const Pending& b)
              { return std::pair(a.entry.id, a.entry.index) < std::pair(b.entry.id, b.entry.index); });
    for (size_t i = 1; i < pending.size(); ++i)
        check(pending[i - 1].entry.id != pending[i].entry.id || pending[i - 1].entry.index != pending[i].entry.index,
              "chunk {} {} is given twice", chunkName(pending[i].entry.id), pending[i].entry.index);
    return pending;
}

/// META first, beside the table, so that `info` touches few pages; then the bulk in table order.
uint64_t placeChunks(std::vector<Pending>& pending)
{
    uint64_t end = sizeof(Header) + pending.size() * sizeof(ChunkEntry);
    for (const bool bulk : {false, true})
    {
        for (Pending& p : pending)
        {
            if ((p.entry.id != kMetaChunk) != bulk)
                continue;
            p.entry.offset = alignUp(end, p.entry.alignment);
            end = p.entry.offset + p.entry.stored_bytes;
        }
    }
    return end;
}

std::vector<std::byte> headerAndTable(const std::vector<Pending>& pending, uint64_t file_bytes)
{
    std::vector<ChunkEntry> table;
    for (const Pending& p : pending)
        table.push_back(p.entry);
    const size_t table_bytes = table.size() * sizeof(ChunkEntry);

    Header header{.magic = kMagic,
                  .version_major = kVersionMajor,
                  .version_minor = kVersionMinor,
                  .file_bytes = file_bytes,
                  .chunk_table_offset = sizeof(Header),
                  .chunk_count = uint32_t(table.size()),
                  .reserved = 0,
                  .chunk_table_hash = XXH3_64bits(table.data(), table_bytes),
                  .header_hash = 0};
    header.header_hash = XXH3_64bits(&header, offsetof(Header, header_hash));

    std::vector<std::byte> bytes(sizeof(Header) + table_bytes);
    std::memcpy(bytes.data(), &header, sizeof(Header));
    std::memcpy(bytes.data() + sizeof(Header), table.data(), table_bytes);
    return bytes;
}

bool padTo(TemporaryFile& file, uint64_t offset)
{
    static constexpr std::array<std::byte, kBulkAlignment> kZeros{};
    check(offset >= file.position() && offset - file.position() <= kZeros.size(), "padding from {} to {}",
          file.position(), offset);
    return file.append(std::span(kZeros).first(offset - file.position()));
}

Error ioError(const char* what)
{
    return {ExitCode::kIo, fmt::format("cannot {}: {}", what, std::strerror(errno))};
}
} // namespace

Result<std::vector<WrittenChunk>> write(const std::filesystem::path& path, std::span<const ChunkSource> chunks,
                                        const WriteOptions& options)
{
    std::vector<Pending> pending = prepare(chunks, options);
    check(!pending.empty() && pending.size() <= kMaxChunkCount, "{} chunks", pending.size());
    const uint64_t file_bytes = placeChunks(pending);

    TemporaryFile file(path);
    if (!file.isOpen())
        return ioError("create the output file");
    if (!file.append(headerAndTable(pending, file_bytes)))
        return ioError("write the output file");

    std::vector<const Pending*> by_offset;
    for (const Pending& p : pending)
        by_offset.push_back(&p);
    std::sort(by_offset.begin(), by_offset.end(),
              [](const Pending* a, const Pending* b) { return a->entry.offset < b->entry.offset; });
    for (const Pending* p : by_offset)
    {
        if (!padTo(file, p->entry.offset) || !file.append(p->stored))
            return ioError("write the output file");
    }
    if (!file.commit())
        return ioError("finish the output file");

    std::vector<WrittenChunk> written;
    for (const Pending& p : pending)
        written.push_back({p.entry.id, p.entry.index, p.entry.stored_bytes, p.entry.raw_bytes});
    return written;
}
} // namespace package
