// How large the texels of a texture page are.
#pragma once
#include "format/block_texture.h"
#include "format/package_generated.h"

namespace package
{
using lumicut::fb::TextureEncoding;

inline constexpr bool isSrgb(TextureEncoding encoding)
{
    return encoding == TextureEncoding::Rgba8Srgb || encoding == TextureEncoding::Bc7Srgb;
}
inline constexpr bool isBlocks(TextureEncoding encoding)
{
    return encoding != TextureEncoding::Rgba8Srgb && encoding != TextureEncoding::Rgba8Unorm;
}
/// Of a 4 x 4 block, or of a texel where there are no blocks.
inline constexpr uint32_t unitBytes(TextureEncoding encoding)
{
    return !isBlocks(encoding) ? 4 : encoding == TextureEncoding::Bc4Unorm ? 8 : 16;
}
/// Blocks, or texels, side by side in a row of `side` texels.
inline constexpr uint32_t unitsAcross(TextureEncoding encoding, uint32_t side)
{
    return isBlocks(encoding) ? blocks::acrossSide(side) : side;
}
/// Of one layer of one level.
inline constexpr uint64_t levelBytes(TextureEncoding encoding, uint32_t width, uint32_t height)
{
    return uint64_t(unitsAcross(encoding, width)) * unitsAcross(encoding, height) * unitBytes(encoding);
}
} // namespace package
