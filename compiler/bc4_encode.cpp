#include "compiler/bc4_encode.h"

#include <algorithm>
#include <cmath>

namespace
{
struct Candidate
{
    uint32_t first = 0, second = 0; // endpoints; seven steps between them where first > second, else five, 0 and 255
    std::array<uint8_t, 16> places{};
    float error = INFINITY;
};

/// Steps from the second endpoint (0) to the first, or `steps` + 1 and + 2 for 0 and 255 themselves.
Candidate placed(const Lanes& values, uint32_t high, uint32_t low, uint32_t steps)
{
    Candidate out{steps == 7 ? high : low, steps == 7 ? low : high, {}, 0};
    const float width = float(high - low), scale = width > 0 ? float(steps) / width : 0;
    for (size_t i = 0; i < 16; ++i)
    {
        const float step = std::floor(std::clamp((values[i] - float(low)) * scale, 0.0f, float(steps)) + 0.5f);
        float distance = std::fabs(values[i] - float(low) - step * width / float(steps));
        out.places[i] = uint8_t(step);
        if (steps == 5 && values[i] < distance)
            distance = values[i], out.places[i] = 6;
        if (steps == 5 && 255 - values[i] < distance)
            distance = 255 - values[i], out.places[i] = 7;
        out.error += distance * distance;
    }
    return out;
}

/// The best endpoints for the present indices (least squares), and their neighbours.
void refine(const Lanes& values, uint32_t steps, Candidate& best)
{
    float aa = 0, ab = 0, bb = 0, av = 0, bv = 0;
    for (size_t i = 0; i < 16; ++i)
    {
        if (best.places[i] > steps)
            continue;
        const float b = float(best.places[i]) / float(steps), a = 1 - b;
        aa += a * a, ab += a * b, bb += b * b, av += a * values[i], bv += b * values[i];
    }
    const float determinant = aa * bb - ab * ab;
    if (determinant < 1e-4f)
        return;
    const int low = int(std::lround(std::clamp((av * bb - bv * ab) / determinant, 0.0f, 255.0f)));
    const int high = int(std::lround(std::clamp((bv * aa - av * ab) / determinant, 0.0f, 255.0f)));
    for (int l = std::max(low - 1, 0); l <= std::min(low + 1, 255); ++l)
        for (int h = std::max({high - 1, l + 1, 0}); h <= std::min(high + 1, 255); ++h)
            if (const Candidate next = placed(values, uint32_t(h), uint32_t(l), steps); next.error < best.error)
                best = next;
}

/// The index that stands for a place (see Candidate).
uint64_t indexOf(uint32_t place, uint32_t steps)
{
    if (steps == 7) // 0 the first endpoint, 1 the second, 2.. from the first to the second
        return place == 7 ? 0 : place == 0 ? 1 : 8 - place;
    return place == 0 ? 0 : place == 5 ? 1 : place < 5 ? place + 1 : place; // there the first endpoint is the lower one
}
} // namespace

void encodeBc4(const Lanes& values, std::span<std::byte, 8> block)
{
    const auto low = uint32_t(std::lround(least(values))), high = uint32_t(std::lround(greatest(values)));
    Candidate best = placed(values, high, low, 7);
    uint32_t steps = 7;
    if (high > low && best.error > 0)
        refine(values, 7, best);
    if (best.error > 16 && (low == 0 || high == 255)) // what lies between the extremes may fit by itself
    {
        float inner_low = 255, inner_high = 0;
        for (size_t i = 0; i < 16; ++i)
            if (values[i] > 0.5f && values[i] < 254.5f)
                inner_low = std::min(inner_low, values[i]), inner_high = std::max(inner_high, values[i]);
        if (inner_low <= inner_high)
        {
            Candidate inner = placed(values, uint32_t(std::lround(inner_high)), uint32_t(std::lround(inner_low)), 5);
            refine(values, 5, inner);
            if (inner.error < best.error)
                best = inner, steps = 5;
        }
    }
    block[0] = std::byte(best.first);
    block[1] = std::byte(best.second);
    uint64_t indices = 0;
    for (size_t i = 0; i < 16 && best.first != best.second; ++i) // equal ones: index 0 everywhere
        indices |= indexOf(best.places[i], steps) << (3 * i);
    if (best.first == best.second && steps == 5)
        for (size_t i = 0; i < 16; ++i)
            indices |= uint64_t(best.places[i] > 5 ? best.places[i] : 0) << (3 * i);
    for (size_t i = 0; i < 6; ++i)
        block[2 + i] = std::byte(indices >> (8 * i));
}
