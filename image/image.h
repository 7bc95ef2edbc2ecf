// A picture in memory, as the tools and the player's capture exchange it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

/// Linear Rec. 709 radiance, row 0 on top.
struct ImageF
{
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<float> rgb; // [3 * width * height]

    size_t pixelCount() const { return size_t(width) * height; }
};
