// Whatever the bytes: opening a package ends in an error or in a package that can be walked without leaving it.
#include "tests/format/rehash.h"
#include "tests/format/walk_package.h"

#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed);
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

/// Most of a small package is padding, where a changed byte is refused at once: aim at the chunks and the table.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed)
{
    std::minstd_rand random(seed);
    package::Header header;
    if (size < sizeof(header) || random() % 16 == 0)
        return LLVMFuzzerMutate(data, size, max_size);
    std::memcpy(&header, data, sizeof(header));
    const uint64_t table_bytes = uint64_t(header.chunk_count) * sizeof(package::ChunkEntry);
    if (header.chunk_count == 0 || header.chunk_table_offset > size || table_bytes > size - header.chunk_table_offset)
        return LLVMFuzzerMutate(data, size, max_size);

    uint64_t offset = header.chunk_table_offset;
    uint64_t bytes = table_bytes;
    if (random() % 8 != 0)
    {
        package::ChunkEntry entry;
        std::memcpy(&entry, data + offset + random() % header.chunk_count * sizeof(entry), sizeof(entry));
        if (entry.offset > size || entry.stored_bytes > size - entry.offset || entry.stored_bytes == 0)
            return LLVMFuzzerMutate(data, size, max_size);
        offset = entry.offset;
        bytes = entry.stored_bytes;
    }
    LLVMFuzzerMutate(data + offset, bytes, bytes);
    return size;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    std::vector<std::byte> bytes(size);
    if (size > 0)
        std::memcpy(bytes.data(), data, size);
    if (const auto package = package::Package::openBytes(bytes))
        walkPackage(*package);
    rehash(bytes); // a fuzzer does not guess hashes
    if (const auto package = package::Package::openBytes(bytes))
        walkPackage(*package);
    return 0;
}
