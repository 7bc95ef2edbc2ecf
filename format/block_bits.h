// Reads the fields of a 16-byte block, lowest bit of the lowest byte first.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace blocks
{
class BitReader
{
public:
    explicit BitReader(std::span<const std::byte, 16> block) { std::memcpy(words_, block.data(), sizeof(words_)); }

    uint32_t take(uint32_t count) // 0 to 32; past the end: zeroes
    {
        const uint32_t value = peek(at_, count);
        at_ += count;
        return value;
    }
    uint32_t position() const { return at_; }

private:
    uint32_t peek(uint32_t at, uint32_t count) const
    {
        if (at >= 128 || count == 0)
            return 0;
        uint64_t bits = words_[at / 64] >> (at % 64);
        if (at / 64 == 0 && at % 64 != 0)
            bits |= words_[1] << (64 - at % 64);
        return uint32_t(bits & ((uint64_t(1) << count) - 1));
    }

    uint64_t words_[2];
    uint32_t at_ = 0;
};
} // namespace blocks
