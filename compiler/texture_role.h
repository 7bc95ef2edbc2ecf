// What materials read from an image, which determines how it is filtered and compressed.
#pragma once
#include "compiler/scene_data.h"

#include <cstdint>
#include <span>
#include <vector>

inline constexpr uint32_t kAllChannels = gpu::kRed | gpu::kGreen | gpu::kBlue | gpu::kAlpha;

struct TextureRole
{
    uint32_t channels = 0;     // gpu::kRed .. that any material reads
    bool normal = false;       // unit vectors and nothing else
    bool covers = false;       // alpha is the coverage of the colour, for every material that reads it
    float coverage_cutoff = 0; // what passes the alpha test; 0: no material tests it
    auto operator<=>(const TextureRole&) const = default;
};

/// @return one an image
std::vector<TextureRole> textureRoles(std::span<const gpu::Material> materials, std::span<const TextureUse> uses,
                                      size_t image_count);
