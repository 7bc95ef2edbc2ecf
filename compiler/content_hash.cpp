#include "compiler/content_hash.h"

#include "compiler/source_hash.h"

#include <fmt/format.h>
#include <xxhash.h>

struct Hasher::State
{
    struct Release
    {
        void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
    };
    std::unique_ptr<XXH3_state_t, Release> xxh{XXH3_createState()};
};

std::string ContentHash::hex() const
{
    return fmt::format("{:016x}{:016x}", high, low);
}

Hasher::Hasher(std::string_view what) : state_(std::make_unique<State>())
{
    XXH3_128bits_reset(state_->xxh.get());
    bytes(std::as_bytes(std::span(what)));
    bytes(std::as_bytes(std::span(compilerHash())));
}
Hasher::Hasher(Hasher&&) noexcept = default;
Hasher::~Hasher() = default;

Hasher& Hasher::bytes(std::span<const std::byte> data)
{
    const uint64_t size = data.size();
    XXH3_128bits_update(state_->xxh.get(), &size, sizeof size);
    XXH3_128bits_update(state_->xxh.get(), data.data(), data.size());
    return *this;
}

ContentHash Hasher::finish() const
{
    const XXH128_hash_t hash = XXH3_128bits_digest(state_->xxh.get());
    return {hash.low64, hash.high64};
}

ContentHash hashOf(std::span<const std::byte> content)
{
    const XXH128_hash_t hash = XXH3_128bits(content.data(), content.size());
    return {hash.low64, hash.high64};
}

std::string_view compilerHash()
{
    return kSourceHash;
}
