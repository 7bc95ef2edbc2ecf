// The levels of a texture: 2 x 2 averages in linear light, quantised only where they are read out.
#pragma once
#include "compiler/lanes.h"
#include "compiler/texture_role.h"

#include <array>
#include <vector>

/// Scales the vector that a normal map's texel encodes (0 to 255 is -1 to 1) to unit length; (0, 0, 1) if that is impossible.
void normalizeTexel(std::array<float, 4>& texel);

class MipChain
{
public:
    /// Level 0 stays in `image`, which must outlive the chain; the others, sides halved and rounded down, are made here.
    /// Normals are averaged as vectors. Where alpha covers, colours count by it; where it is tested, it is scaled in every
    /// level so that as many texels pass as in level 0 (Castano 2010, "Computing Alpha Mipmaps").
    MipChain(const TextureImage& image, const TextureRole& role);

    uint32_t levels() const { return uint32_t(levels_.size()) + 1; }
    uint32_t width(uint32_t level) const { return level == 0 ? image_.width : levels_[level - 1].width; }
    uint32_t height(uint32_t level) const { return level == 0 ? image_.height : levels_[level - 1].height; }

    /// One texel as the package encodes it, 0 to 255 but not rounded: sRGB-encoded colour is. Of level 0 exactly what the
    /// image has, but in more bits where it has them.
    std::array<float, 4> texel(uint32_t level, uint32_t x, uint32_t y) const;

private:
    struct Level
    {
        uint32_t width = 0, height = 0;
        float alpha_scale = 1;
        std::vector<float> rgba; // [4 * width * height], linear, 0 to 1
    };
    std::array<float, 4> linear(uint32_t x, uint32_t y) const; // of level 0
    template <typename Texel>
    Level halved(uint32_t width, uint32_t height, const Texel& at) const;
    void keepCoverage();

    const TextureImage& image_;
    TextureRole role_;
    std::vector<Level> levels_; // 1 and on
};
