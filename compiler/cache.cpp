#include "compiler/cache.h"

#include "format/mapped_file.h"
#include "format/temporary_file.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>

namespace
{
constexpr std::string_view kSuffix = ".lumicache";

/// Before the result's bytes in a file.
struct Header
{
    std::array<char, 8> magic;
    ContentHash key;
    uint64_t bytes; // after the header
    ContentHash content;
};
constexpr std::array<char, 8> kMagic{'L', 'U', 'M', 'I', 'C', 'A', 'C', '1'};

struct Entry
{
    std::filesystem::path path;
    uint64_t bytes;
    std::filesystem::file_time_type used;
};
} // namespace

Result<Cache> Cache::open(const std::filesystem::path& folder)
{
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (problem)
        return Error{ExitCode::kIo, fmt::format("the cache folder cannot be made: {}", problem.message()),
                     folder.string()};
    if (!std::filesystem::is_directory(folder, problem) || access(folder.c_str(), W_OK | X_OK) != 0)
        return Error{ExitCode::kIo, "the cache must be a folder that can be written to", folder.string()};
    Cache cache;
    cache.folder_ = folder;
    return cache;
}

Cache::Cache(Cache&& other) noexcept
{
    *this = std::move(other);
}

Cache& Cache::operator=(Cache&& other) noexcept
{
    folder_ = std::move(other.folder_);
    other.folder_.clear();
    hits_ = other.hits_.load();
    misses_ = other.misses_.load();
    return *this;
}

std::filesystem::path Cache::pathOf(const ContentHash& key) const
{
    return folder_ / (key.hex() + std::string(kSuffix));
}

std::optional<std::vector<std::byte>> Cache::find(const ContentHash& key) const
{
    if (!isOpen())
        return std::nullopt;
    ++misses_;
    const std::filesystem::path path = pathOf(key);
    const Result<package::MappedFile> file = package::MappedFile::open(path);
    if (!file || file->bytes().size() < sizeof(Header))
        return std::nullopt;
    Header header;
    std::memcpy(&header, file->bytes().data(), sizeof header);
    const std::span<const std::byte> result = file->bytes().subspan(sizeof header);
    if (header.magic != kMagic || header.key != key || header.bytes != result.size() ||
        header.content != hashOf(result))
        return std::nullopt;
    utimensat(AT_FDCWD, path.c_str(), nullptr, 0); // used now, for trim()
    --misses_;
    ++hits_;
    return std::vector<std::byte>(result.begin(), result.end());
}

void Cache::store(const ContentHash& key, std::span<const std::span<const std::byte>> parts) const
{
    if (!isOpen())
        return;
    std::vector<std::byte> joined; // hashed together
    for (const std::span<const std::byte> part : parts)
        joined.insert(joined.end(), part.begin(), part.end());
    const Header header{kMagic, key, joined.size(), hashOf(joined)};
    TemporaryFile file(pathOf(key));
    if (file.isOpen() && file.append(std::as_bytes(std::span(&header, 1))) && file.append(joined))
        file.commit(Durability::kUntilPowerCut); // what a power cut leaves of it does not match its hash
}

void Cache::trim(uint64_t bytes) const
{
    if (!isOpen())
        return;
    std::vector<Entry> entries;
    uint64_t total = 0;
    std::error_code problem;
    for (std::filesystem::directory_iterator it(folder_, problem), end; !problem && it != end; it.increment(problem))
    {
        std::error_code gone; // another program may be trimming, too
        if (it->path().extension() == ".tmp" &&
            it->last_write_time(gone) + std::chrono::hours(24) < std::filesystem::file_time_type::clock::now())
            std::filesystem::remove(it->path(), gone); // of a program that was killed
        if (it->path().extension() != kSuffix)
            continue;
        const Entry entry{it->path(), it->file_size(gone), it->last_write_time(gone)};
        if (gone)
            continue;
        total += entry.bytes;
        entries.push_back(entry);
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
    for (const Entry& entry : entries)
    {
        if (total <= bytes)
            break;
        std::filesystem::remove(entry.path, problem);
        total -= entry.bytes;
    }
}
