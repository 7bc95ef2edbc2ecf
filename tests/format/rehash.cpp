#include "tests/format/rehash.h"

#include "format/package_layout.h"

#include <xxhash.h>

#include <cstring>

void rehash(std::span<std::byte> file)
{
    package::Header header;
    if (file.size() < sizeof(header))
        return;
    std::memcpy(&header, file.data(), sizeof(header));
    header.file_bytes = file.size();
    const uint64_t table_bytes = uint64_t(header.chunk_count) * sizeof(package::ChunkEntry);
    if (header.chunk_table_offset <= file.size() && table_bytes <= file.size() - header.chunk_table_offset)
    {
        std::byte* table = file.data() + header.chunk_table_offset;
        for (uint32_t i = 0; i < header.chunk_count; ++i)
        {
            package::ChunkEntry entry;
            std::memcpy(&entry, table + i * sizeof(entry), sizeof(entry));
            if (entry.offset <= file.size() && entry.stored_bytes <= file.size() - entry.offset)
                entry.hash = XXH3_64bits(file.data() + entry.offset, entry.stored_bytes);
            std::memcpy(table + i * sizeof(entry), &entry, sizeof(entry));
        }
        header.chunk_table_hash = XXH3_64bits(table, table_bytes);
    }
    header.header_hash = XXH3_64bits(&header, offsetof(package::Header, header_hash));
    std::memcpy(file.data(), &header, sizeof(header));
}
