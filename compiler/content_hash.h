// 128-bit hashes of content: what files held, and what a stage's result was made from.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

/// XXH3-128: detects accidental differences, not forgery.
struct ContentHash
{
    uint64_t low = 0;
    uint64_t high = 0;
    bool operator==(const ContentHash&) const = default;
    std::string hex() const; // 32 lower-case digits
};

/// Hashes a sequence of arrays and values. Lengths count, so that no two sequences run into each other.
class Hasher
{
public:
    /// @param what the calling stage; the hash of the sources of this program is part of the key
    explicit Hasher(std::string_view what);
    Hasher(Hasher&&) noexcept;
    ~Hasher();

    Hasher& bytes(std::span<const std::byte> data);

    template <typename T>
    Hasher& array(const std::vector<T>& data)
    {
        static_assert(std::has_unique_object_representations_v<T> || std::is_standard_layout_v<T>);
        return bytes(std::as_bytes(std::span(data)));
    }
    template <typename... T>
    Hasher& values(const T&... v)
    {
        (bytes(std::as_bytes(std::span(&v, 1))), ...);
        return *this;
    }
    ContentHash finish() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

ContentHash hashOf(std::span<const std::byte> content);

/// Hash of the sources of compiler and package format: another version may produce other output from the same input.
std::string_view compilerHash();
