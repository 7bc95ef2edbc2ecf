#include "format/package_container.h"

#include "format/check.h"
#include "format/parallel.h"

#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>

namespace package
{
namespace
{
constexpr size_t kParallelBytes = 1u << 20; // below this, starting threads costs more than it saves

template <typename... Args>
Error invalid(fmt::format_string<Args...> format, Args&&... args)
{
    return {ExitCode::kInvalid, fmt::format(format, std::forward<Args>(args)...)};
}

bool startsWith(std::span<const std::byte> file, std::string_view prefix)
{
    return std::string_view(reinterpret_cast<const char*>(file.data()), file.size()).starts_with(prefix);
}

/// What a file with a wrong magic most likely is.
Error describeForeign(std::span<const std::byte> file)
{
    using namespace std::string_view_literals;
    // Line endings rewritten, high bits stripped, or Latin-1 taken for text and re-encoded as UTF-8.
    for (const std::string_view damaged : {"\xABLUMI 1\xBB"sv, "\x2BLUMI 1\x3B"sv, "\xC2\xABLUMI 1\xC2\xBB"sv})
    {
        if (startsWith(file, damaged))
            return invalid("this package was damaged by a transfer in text mode; copy it again as a binary file");
    }
    if (startsWith(file, "glTF"sv) || startsWith(file, "{"sv))
        return invalid(
            "this is not a Lumicut package but looks like a glTF file; compile it with lumicut-compile first");
    return invalid("this is not a Lumicut package: it does not start with the bytes of one");
}

Result<Header> readHeader(std::span<const std::byte> file)
{
    const std::string_view magic(reinterpret_cast<const char*>(kMagic.data()), kMagic.size());
    if (!startsWith(file, magic.substr(0, file.size())))
        return describeForeign(file);
    if (file.size() < sizeof(Header))
        return invalid("the package is truncated: {} bytes are left, its header alone takes {}; copy it again",
                       file.size(), sizeof(Header));
    Header header;
    std::memcpy(&header, file.data(), sizeof(Header));

    // Before the hash: a later major version may have another header.
    if (header.version_major != kVersionMajor)
        return Error{ExitCode::kUnsupported,
                     fmt::format("the package has format version {}.{}, this program reads version {}; {}",
                                 header.version_major, header.version_minor, kVersionMajor,
                                 header.version_major > kVersionMajor ? "use a newer Lumicut" : "compile it again")};
    if (header.header_hash != XXH3_64bits(file.data(), offsetof(Header, header_hash)))
        return invalid("the package's header is damaged (its hash does not match); copy or compile it again");
    if (file.size() < header.file_bytes)
        return invalid("the package is truncated: {} of {} bytes are there; copy it again", file.size(),
                       header.file_bytes);
    if (file.size() > header.file_bytes)
        return invalid("the package has {} bytes more than its header says; copy it again",
                       file.size() - header.file_bytes);
    if (header.reserved != 0)
        return invalid("the header's reserved field is {}, not 0", header.reserved);
    return header;
}

Result<std::vector<ChunkEntry>> readTable(std::span<const std::byte> file, const Header& header)
{
    if (header.chunk_count == 0 || header.chunk_count > kMaxChunkCount)
        return invalid("the header counts {} chunks, allowed are 1 to {}", header.chunk_count, kMaxChunkCount);
    const uint64_t table_bytes = header.chunk_count * sizeof(ChunkEntry);
    const uint64_t offset = header.chunk_table_offset;
    if (offset < sizeof(Header) || offset > file.size() || file.size() - offset < table_bytes)
        return invalid("the chunk table at byte {} with {} bytes does not lie inside the file", offset, table_bytes);
    if (header.chunk_table_hash != XXH3_64bits(file.data() + offset, table_bytes))
        return invalid("the chunk table is damaged (its hash does not match); copy or compile the package again");
    std::vector<ChunkEntry> table(header.chunk_count);
    std::memcpy(table.data(), file.data() + offset, table_bytes);
    return table;
}

bool isKnown(uint32_t id)
{
    constexpr std::array kKnown{kMetaChunk,           kBvhNodesChunk,          kLeafTrianglesChunk,  kTrianglesChunk,
                                kPositionsChunk,      kVertexAttributesChunk,  kVertexExtrasChunk,   kMaterialsChunk,
                                kTextureRefsChunk,    kTexturePageChunk,       kLightsChunk,         kLightAliasesChunk,
                                kEnvironmentChunk,    kEnvironmentTexelsChunk, kCausticTargetsChunk, kMotionChunk,
                                kMovingVerticesChunk, kInfluencesChunk,        kMorphOffsetsChunk,   kLightYieldsChunk};
    return std::find(kKnown.begin(), kKnown.end(), id) != kKnown.end();
}

Status verifySizes(const ChunkEntry& entry, const std::string& name)
{
    const bool packed = entry.codec == Codec::kZstd;
    const uint32_t required_alignment =
        packed || entry.id == kMetaChunk || !isKnown(entry.id) ? kSmallAlignment : kBulkAlignment;
    if (!std::has_single_bit(entry.alignment) || entry.alignment < required_alignment)
        return invalid("chunk {} {}: alignment {} is not a power of two of at least {}", name, entry.index,
                       entry.alignment, required_alignment);
    if (entry.offset % entry.alignment != 0)
        return invalid("chunk {} {}: offset {} is no multiple of its alignment {}", name, entry.index, entry.offset,
                       entry.alignment);
    if (entry.stored_bytes == 0)
        return invalid("chunk {} {}: it is empty; empty chunks are left out of a package", name, entry.index);
    if (!isKnown(entry.id))
        return Success{};
    if (!packed && entry.raw_bytes != entry.stored_bytes)
        return invalid("chunk {} {}: {} bytes are stored without a codec but {} are promised", name, entry.index,
                       entry.stored_bytes, entry.raw_bytes);
    // A few bytes of zstd can promise petabytes: bound the promise before anybody allocates it.
    if (packed && (entry.raw_bytes == 0 || entry.raw_bytes / kMaxExpansion > entry.stored_bytes))
        return invalid("chunk {} {}: {} compressed bytes promise {}, allowed is at most {} times as much", name,
                       entry.index, entry.stored_bytes, entry.raw_bytes, kMaxExpansion);
    if (entry.id == kMetaChunk && entry.raw_bytes > kMaxMetaBytes)
        return invalid("chunk META: {} bytes, allowed are {}", entry.raw_bytes, kMaxMetaBytes);
    return Success{};
}

Status verifyEntry(const ChunkEntry& entry, uint64_t file_bytes)
{
    const std::string name = chunkName(entry.id);
    if (entry.required > 1 || entry.reserved != 0)
        return invalid("chunk {} {}: its flags are {} and {}, allowed are 0 or 1 and 0", name, entry.index,
                       entry.required, entry.reserved);
    if (entry.required == 1 && !isKnown(entry.id))
        return Error{ExitCode::kUnsupported,
                     fmt::format("chunk {} {}: this program does not know it but the package requires it; use a newer "
                                 "Lumicut",
                                 name, entry.index)};
    if (isKnown(entry.id) && entry.codec != Codec::kNone && entry.codec != Codec::kZstd)
        return Error{ExitCode::kUnsupported, fmt::format("chunk {} {}: it is compressed with codec {}, which this "
                                                         "program does not know; use a newer Lumicut",
                                                         name, entry.index, uint32_t(entry.codec))};
    if (entry.id != kTexturePageChunk && isKnown(entry.id) && entry.index != 0)
        return invalid("chunk {} {}: only index 0 is allowed", name, entry.index);
    if (Status sizes = verifySizes(entry, name); !sizes)
        return sizes;
    if (entry.offset > file_bytes || file_bytes - entry.offset < entry.stored_bytes)
        return invalid("chunk {} {}: {} bytes at byte {} do not lie inside the file of {} bytes", name, entry.index,
                       entry.stored_bytes, entry.offset, file_bytes);
    return Success{};
}

/// Header, table and chunks must not overlap; what lies between them must be zero.
Status verifyPlacement(std::span<const std::byte> file, const Header& header, std::span<const ChunkEntry> table)
{
    struct Range
    {
        uint64_t begin, end;
        std::string name;
    };
    std::vector<Range> ranges{{0, sizeof(Header), "the header"},
                              {header.chunk_table_offset,
                               header.chunk_table_offset + header.chunk_count * sizeof(ChunkEntry), "the chunk table"}};
    for (const ChunkEntry& entry : table)
        ranges.push_back({entry.offset, entry.offset + entry.stored_bytes,
                          fmt::format("chunk {} {}", chunkName(entry.id), entry.index)});
    std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) { return a.begin < b.begin; });
    ranges.push_back({file.size(), file.size(), "the end of the file"});

    for (size_t i = 1; i < ranges.size(); ++i)
    {
        if (ranges[i].begin < ranges[i - 1].end)
            return invalid("{} overlaps {}", ranges[i].name, ranges[i - 1].name);
    }
    for (size_t i = 1; i < ranges.size(); ++i)
    {
        const auto gap = file.subspan(ranges[i - 1].end, ranges[i].begin - ranges[i - 1].end);
        if (std::any_of(gap.begin(), gap.end(), [](std::byte b) { return b != std::byte{0}; }))
            return invalid("the padding between {} and {} is not zero", ranges[i - 1].name, ranges[i].name);
    }
    return Success{};
}

Status decompress(const ChunkEntry& entry, std::span<const std::byte> stored, std::unique_ptr<std::byte[]>& storage)
{
    const std::string name = chunkName(entry.id);
    if (ZSTD_getFrameContentSize(stored.data(), stored.size()) != entry.raw_bytes)
        return invalid("chunk {} {}: its zstd frame does not hold the {} bytes that the table promises", name,
                       entry.index, entry.raw_bytes);
    storage = std::make_unique_for_overwrite<std::byte[]>(entry.raw_bytes);
    const size_t size = ZSTD_decompress(storage.get(), entry.raw_bytes, stored.data(), stored.size());
    if (ZSTD_isError(size))
        return invalid("chunk {} {}: it cannot be decompressed: {}", name, entry.index, ZSTD_getErrorName(size));
    if (size != entry.raw_bytes)
        return invalid("chunk {} {}: it decompresses to {} bytes, the table promises {}", name, entry.index, size,
                       entry.raw_bytes);
    return Success{};
}

Status loadChunks(std::span<const std::byte> file, Unpack unpack, Container& container)
{
    container.chunks.resize(container.table.size());
    container.storage.resize(container.table.size());
    std::vector<std::function<Status()>> tasks;
    for (size_t i = 0; i < container.table.size(); ++i)
    {
        tasks.emplace_back(
            [&container, file, unpack, i]() -> Status
            {
                const ChunkEntry& entry = container.table[i];
                const auto stored = file.subspan(entry.offset, entry.stored_bytes);
                if (XXH3_64bits(stored.data(), stored.size()) != entry.hash)
                    return invalid("chunk {} {}: it is damaged (its hash does not match); copy or compile the package "
                                   "again",
                                   chunkName(entry.id), entry.index);
                container.chunks[i] = stored;
                if (entry.codec == Codec::kNone || !isKnown(entry.id) ||
                    (unpack == Unpack::kMeta && entry.id != kMetaChunk))
                    return Success{};
                Status status = decompress(entry, stored, container.storage[i]);
                container.chunks[i] = {container.storage[i].get(), entry.raw_bytes};
                return status;
            });
    }
    return runAll(tasks, file.size() >= kParallelBytes);
}
} // namespace

std::span<const std::byte> Container::find(uint32_t id, uint32_t index) const
{
    for (size_t i = 0; i < table.size(); ++i)
    {
        if (table[i].id == id && table[i].index == index)
            return chunks[i];
    }
    return {};
}

Result<Container> readContainer(std::span<const std::byte> file, Unpack unpack)
{
    Result<Header> header = readHeader(file);
    if (!header)
        return header.error();
    Result<std::vector<ChunkEntry>> table = readTable(file, *header);
    if (!table)
        return table.error();

    Container container;
    container.table = std::move(*table);
    for (size_t i = 0; i < container.table.size(); ++i)
    {
        const ChunkEntry& entry = container.table[i];
        if (Status status = verifyEntry(entry, file.size()); !status)
            return status.error();
        if (i == 0)
            continue;
        const ChunkEntry& previous = container.table[i - 1];
        if (std::pair(previous.id, previous.index) >= std::pair(entry.id, entry.index))
            return invalid("chunk {} {}: the table is not sorted by id and index, or lists it twice",
                           chunkName(entry.id), entry.index);
    }
    if (Status status = verifyPlacement(file, *header, container.table); !status)
        return status.error();
    if (Status status = loadChunks(file, unpack, container); !status)
        return status.error();
    return container;
}
} // namespace package
