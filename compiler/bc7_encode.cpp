#include "compiler/bc7_encode.h"

#include "compiler/bc7_line.h"
#include "format/bc7_tables.h"

#include <cstring>

namespace
{
using bc7::Line;

// Sums of squares over a block from which on another mode is tried: about 1.2 and 2 steps of 255 a channel.
constexpr float kGood = 16 * 3 * 1.5f;
constexpr float kFair = 16 * 3 * 4.0f;

class BitWriter
{
public:
    void put(uint32_t value, uint32_t count)
    {
        words_[at_ / 64] |= uint64_t(value) << (at_ % 64);
        if (at_ % 64 + count > 64)
            words_[1] |= uint64_t(value) >> (64 - at_ % 64);
        at_ += count;
    }
    void store(std::span<std::byte, 16> block) const { std::memcpy(block.data(), words_, 16); }

private:
    uint64_t words_[2] = {0, 0};
    uint32_t at_ = 0;
};

/// Where an endpoint goes that lies halfway between two that can be stored: one end of a line up and the other down, so that
/// a whole number between both is met by the indices in the middle, and blocks come out neither brighter nor darker.
enum class Halfway
{
    kUp,
    kDown,
};

uint32_t nearest(float value, uint32_t highest, Halfway halfway)
{
    const float whole = halfway == Halfway::kUp ? std::floor(value + 0.5f) : std::ceil(value - 0.5f);
    return uint32_t(std::clamp(whole, 0.0f, float(highest)));
}

float expanded7(uint32_t bits) // as decoders do
{
    return float(bits << 1 | bits >> 6);
}

/// What expanded7() makes of it is `value`; linear between whole numbers, so that rounding it finds the nearest.
float wanted7(float value)
{
    return value <= 126 ? value / 2 : value >= 129 ? (value - 1) / 2 : 63 + (value - 126) / 3;
}

/// An index of the anchor texel has no highest bit: where it would need one, the endpoints change places.
template <typename Ends>
void orient(bc7::Places& places, Ends& first, Ends& second, size_t anchor, int steps, const Lanes& mask)
{
    if (places.indices[anchor] * 2 < float(steps))
        return;
    places.indices = mask * (Lanes::all(float(steps)) - places.indices) + (Lanes::all(1) - mask) * places.indices;
    std::swap(first, second);
}

void putIndices(BitWriter& bits, const Lanes& indices, uint32_t width, size_t second_anchor)
{
    for (size_t i = 0; i < 16; ++i)
        bits.put(uint32_t(indices[i]), width - (i == 0 || i == second_anchor ? 1 : 0));
}

/// Endpoints of mode 6: 7 bits a channel and one lowest bit that the channels share.
template <size_t N>
struct Ends6
{
    struct End
    {
        std::array<uint32_t, 4> bits{};
        uint32_t p = 0;
    };
    Line<N> line; // as decoded; made with the ends, so it stands before them
    End first, second;

    static End quantize(const bc7::Color<N>& color, Halfway halfway, bc7::Color<N>& decoded)
    {
        End best;
        float best_error = INFINITY;
        for (uint32_t p = 0; p < 2; ++p)
        {
            End end;
            end.p = p;
            bc7::Color<N> value;
            float error = 0;
            for (size_t k = 0; k < N; ++k)
            {
                end.bits[k] = nearest((color[k] - float(p)) / 2, 127, halfway);
                value[k] = float(2 * end.bits[k] + p);
                error += (value[k] - color[k]) * (value[k] - color[k]);
            }
            if (error < best_error)
                best_error = error, best = end, decoded = value;
        }
        if (N == 3)
            best.bits[3] = 127;
        return best;
    }
    explicit Ends6(const Line<N>& wanted)
        : first(quantize(wanted.first, Halfway::kUp, line.first)),
          second(quantize(wanted.second, Halfway::kDown, line.second))
    {
    }
};

template <size_t N>
auto fitMode6(const std::array<Lanes, N>& c)
{
    return bc7::fitLine(c, Lanes::all(1), 15, 2, [](const Line<N>& line) { return Ends6<N>(line); });
}

template <typename Fit>
void writeMode6(Fit fit, std::span<std::byte, 16> block)
{
    orient(fit.places, fit.ends.first, fit.ends.second, 0, 15, Lanes::all(1));
    BitWriter bits;
    bits.put(1 << 6, 7);
    for (size_t k = 0; k < 4; ++k)
    {
        bits.put(fit.ends.first.bits[k], 7);
        bits.put(fit.ends.second.bits[k], 7);
    }
    bits.put(fit.ends.first.p, 1);
    bits.put(fit.ends.second.p, 1);
    putIndices(bits, fit.places.indices, 4, 16);
    bits.store(block);
}

/// Endpoints of one subset of mode 1: 6 bits a channel and one lowest bit that both share.
struct Ends1
{
    std::array<uint32_t, 3> first{}, second{};
    uint32_t p = 0;
    Line<3> line;

    explicit Ends1(const Line<3>& wanted)
    {
        float best = INFINITY;
        for (uint32_t shared = 0; shared < 2; ++shared)
        {
            std::array<uint32_t, 3> a, b;
            Line<3> decoded;
            const float error = quantize(wanted.first, shared, Halfway::kUp, a, decoded.first) +
                                quantize(wanted.second, shared, Halfway::kDown, b, decoded.second);
            if (error < best)
                best = error, first = a, second = b, p = shared, line = decoded;
        }
    }
    static float quantize(const bc7::Color<3>& color, uint32_t p, Halfway halfway, std::array<uint32_t, 3>& bits,
                          bc7::Color<3>& decoded)
    {
        float error = 0;
        for (size_t k = 0; k < 3; ++k)
        {
            bits[k] = nearest((wanted7(color[k]) - float(p)) / 2, 63, halfway);
            decoded[k] = expanded7(2 * bits[k] + p);
            error += (decoded[k] - color[k]) * (decoded[k] - color[k]);
        }
        return error;
    }
};

struct Mode1
{
    uint32_t partition = 0;
    std::array<Ends1, 2> ends{Ends1(Line<3>{}), Ends1(Line<3>{})};
    Lanes indices = Lanes::all(0);
    float error = INFINITY;
};

const Lanes& subsetMask(uint32_t partition)
{
    static const auto masks = []
    {
        std::array<Lanes, 64> table;
        for (size_t p = 0; p < 64; ++p)
            for (size_t i = 0; i < 16; ++i)
                table[p].set(i, float(bc7::kTwoSubsets[p] >> i & 1));
        return table;
    }();
    return masks[partition];
}

Mode1 fitMode1(const std::array<Lanes, 3>& c, uint32_t partition)
{
    Mode1 out;
    out.partition = partition;
    out.error = 0;
    for (size_t subset = 0; subset < 2; ++subset)
    {
        const Lanes& one = subsetMask(partition);
        const Lanes mask = subset == 1 ? one : Lanes::all(1) - one;
        auto fit = bc7::fitLine(c, mask, 7, 1, [](const Line<3>& line) { return Ends1(line); });
        orient(fit.places, fit.ends.first, fit.ends.second, subset == 0 ? 0 : bc7::kAnchorOfTwo[partition], 7, mask);
        out.ends[subset] = fit.ends;
        out.indices = out.indices + fit.places.indices * mask;
        out.error += fit.places.error;
    }
    return out;
}

void writeMode1(const Mode1& mode, std::span<std::byte, 16> block)
{
    BitWriter bits;
    bits.put(1 << 1, 2);
    bits.put(mode.partition, 6);
    for (size_t k = 0; k < 3; ++k)
        for (const Ends1& ends : mode.ends)
        {
            bits.put(ends.first[k], 6);
            bits.put(ends.second[k], 6);
        }
    bits.put(mode.ends[0].p, 1);
    bits.put(mode.ends[1].p, 1);
    putIndices(bits, mode.indices, 3, bc7::kAnchorOfTwo[mode.partition]);
    bits.store(block);
}

/// Endpoints of mode 5: 7 bits a channel of colour, 8 bits of the channel by itself.
template <size_t N>
struct Ends5
{
    std::array<uint32_t, 3> first{}, second{};
    Line<N> line;

    explicit Ends5(const Line<N>& wanted)
    {
        for (size_t k = 0; k < N; ++k)
        {
            first[k] = quantize(wanted.first[k], Halfway::kUp, line.first[k]);
            second[k] = quantize(wanted.second[k], Halfway::kDown, line.second[k]);
        }
    }
    static uint32_t quantize(float value, Halfway halfway, float& decoded)
    {
        const uint32_t bits = N == 1 ? nearest(value, 255, halfway) : nearest(wanted7(value), 127, halfway);
        decoded = N == 1 ? float(bits) : expanded7(bits);
        return bits;
    }
};

template <size_t N>
auto fitMode5(const std::array<Lanes, N>& c)
{
    return bc7::fitLine(c, Lanes::all(1), 3, 1, [](const Line<N>& line) { return Ends5<N>(line); });
}

struct Mode5
{
    uint32_t rotation = 0; // 0: alpha by itself; 1, 2, 3: red, green, blue, in alpha's place
    decltype(fitMode5<3>({})) color = fitMode5<3>({});
    decltype(fitMode5<1>({})) scalar = fitMode5<1>({});
    float error = INFINITY;
};

Mode5 fitMode5(std::array<Lanes, 4> c, uint32_t rotation)
{
    if (rotation > 0)
        std::swap(c[3], c[rotation - 1]);
    Mode5 out{rotation, fitMode5<3>({c[0], c[1], c[2]}), fitMode5<1>({c[3]})};
    out.error = out.color.places.error + out.scalar.places.error;
    return out;
}

void writeMode5(Mode5 mode, std::span<std::byte, 16> block)
{
    orient(mode.color.places, mode.color.ends.first, mode.color.ends.second, 0, 3, Lanes::all(1));
    orient(mode.scalar.places, mode.scalar.ends.first, mode.scalar.ends.second, 0, 3, Lanes::all(1));
    BitWriter bits;
    bits.put(1 << 5, 6);
    bits.put(mode.rotation, 2);
    for (size_t k = 0; k < 3; ++k)
    {
        bits.put(mode.color.ends.first[k], 7);
        bits.put(mode.color.ends.second[k], 7);
    }
    bits.put(mode.scalar.ends.first[0], 8);
    bits.put(mode.scalar.ends.second[0], 8);
    putIndices(bits, mode.color.places.indices, 2, 16);
    putIndices(bits, mode.scalar.places.indices, 2, 16);
    bits.store(block);
}

/// The rotation under which the channel by itself takes the most with it.
Mode5 bestMode5(const std::array<Lanes, 4>& c, bool uses_alpha)
{
    Mode5 best;
    for (uint32_t rotation = uses_alpha ? 0 : 1; rotation < 4; ++rotation)
        if (Mode5 mode = fitMode5(c, rotation); mode.error < best.error)
            best = mode;
    return best;
}

void encodeOpaque(const std::array<Lanes, 4>& channels, std::span<std::byte, 16> block)
{
    const std::array<Lanes, 3> c{channels[0], channels[1], channels[2]};
    const auto mode6 = fitMode6(c);
    float error = mode6.places.error;
    if (error <= kGood)
        return writeMode6(mode6, block);
    std::array<uint32_t, 2> partitions;
    bc7::promisingPartitions(c, partitions);
    Mode1 mode1 = fitMode1(c, partitions[0]);
    if (Mode1 other = fitMode1(c, partitions[1]); other.error < mode1.error)
        mode1 = other;
    error = std::min(error, mode1.error);
    if (error > kFair)
        if (const Mode5 mode5 = bestMode5({c[0], c[1], c[2], Lanes::all(255)}, false); mode5.error < error)
            return writeMode5(mode5, block);
    if (mode1.error < mode6.places.error)
        return writeMode1(mode1, block);
    writeMode6(mode6, block);
}
} // namespace

void encodeBc7(const std::array<Lanes, 4>& channels, bool uses_alpha, std::span<std::byte, 16> block)
{
    if (!uses_alpha)
        return encodeOpaque(channels, block);
    const auto mode6 = fitMode6(channels);
    if (mode6.places.error > kGood)
        if (const Mode5 mode5 = bestMode5(channels, true); mode5.error < mode6.places.error)
            return writeMode5(mode5, block);
    writeMode6(mode6, block);
}
