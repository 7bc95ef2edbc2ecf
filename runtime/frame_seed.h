// Random numbers of a sequence's frames.
#pragma once
#include <cstdint>

/// For one `seed` each frame has its own. @param frame may be negative, of warming up
inline uint32_t frameSeed(uint32_t seed, int64_t frame)
{
    // Invertible steps of 32 bits (Wellons' "lowbias32"), so that no two frames of a sequence share a seed.
    const auto mix = [](uint32_t x)
    {
        x = (x ^ x >> 16) * 0x7feb352du;
        x = (x ^ x >> 15) * 0x846ca68bu;
        return x ^ x >> 16;
    };
    return mix(uint32_t(frame) + mix(seed));
}
