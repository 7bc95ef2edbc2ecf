#include "format/package_write.h"

#include "format/check.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
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
                   .required = 1,
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

/// A file that vanishes again unless it is committed to its final name.
class TemporaryFile
{
public:
    explicit TemporaryFile(const std::filesystem::path& target) : target_(target)
    {
        for (int attempt = 0; attempt < 100 && fd_ < 0; ++attempt)
        {
            path_ = target;
            path_ += fmt::format(".{}-{}.tmp", getpid(), attempt);
            fd_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (fd_ < 0 && errno != EEXIST)
                break;
        }
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile()
    {
        if (fd_ < 0)
            return;
        close(fd_);
        if (!committed_)
            unlink(path_.c_str());
    }

    bool isOpen() const { return fd_ >= 0; }

    bool append(std::span<const std::byte> bytes)
    {
        position_ += bytes.size();
        while (!bytes.empty())
        {
            const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR)
                continue;
            if (written < 0)
                return false;
            bytes = bytes.subspan(size_t(written));
        }
        return true;
    }

    bool padTo(uint64_t offset)
    {
        static constexpr std::array<std::byte, kBulkAlignment> kZeros{};
        check(offset >= position_ && offset - position_ <= kZeros.size(), "padding from {} to {}", position_, offset);
        return append(std::span(kZeros).first(offset - position_));
    }

    bool commit()
    {
        if (fsync(fd_) != 0 || rename(path_.c_str(), target_.c_str()) != 0)
            return false;
        committed_ = true;
        // The name itself survives a power cut only once its folder is on disk; some file systems refuse, harmlessly.
        const std::filesystem::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
        const int folder_fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (folder_fd >= 0)
        {
            fsync(folder_fd);
            close(folder_fd);
        }
        return true;
    }

private:
    std::filesystem::path target_;
    std::filesystem::path path_;
    int fd_ = -1;
    uint64_t position_ = 0;
    bool committed_ = false;
};

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
        if (!file.padTo(p->entry.offset) || !file.append(p->stored))
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
