// Results of costly stages, kept in a folder for the next run.
#pragma once
#include "compiler/content_hash.h"
#include "format/result.h"

#include <atomic>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

/// Each result is a file named by its key, the hash of all that it was made from, and is written whole and renamed:
/// several programs may share a folder. A file that is damaged, foreign or of another key counts as missing. A result
/// that cannot be written is made again next time, without an error. Thread-safe.
class Cache
{
public:
    Cache() = default; // keeps nothing

    /// Creates the folder if it is missing. @return kIo if it cannot be created or written to
    static Result<Cache> open(const std::filesystem::path& folder);

    Cache(Cache&& other) noexcept;
    Cache& operator=(Cache&& other) noexcept;

    bool isOpen() const { return !folder_.empty(); }

    std::optional<std::vector<std::byte>> find(const ContentHash& key) const;
    /// @param parts the result's bytes, one part after the other
    void store(const ContentHash& key, std::span<const std::span<const std::byte>> parts) const;

    /// The result of `make()`, a std::vector<uint8_t>, from the folder if it is cached.
    template <typename Make>
    std::vector<uint8_t> through(const ContentHash& key, const Make& make) const
    {
        if (const auto found = find(key))
            return {reinterpret_cast<const uint8_t*>(found->data()),
                    reinterpret_cast<const uint8_t*>(found->data()) + found->size()};
        std::vector<uint8_t> made = make();
        const std::span<const std::byte> part = std::as_bytes(std::span(made));
        store(key, {&part, 1});
        return made;
    }

    /// Removes the results that have not been used for the longest time until those left have at most `bytes` together.
    void trim(uint64_t bytes) const;

    uint32_t hits() const { return hits_; }
    uint32_t misses() const { return misses_; }

private:
    std::filesystem::path pathOf(const ContentHash& key) const;

    std::filesystem::path folder_; // empty: closed
    mutable std::atomic<uint32_t> hits_{0};
    mutable std::atomic<uint32_t> misses_{0};
};
