// Materials and texture references.
#include "format/material.h"
#include "format/package_verify.h"
#include "format/texture_tile.h"

#include <bit>

namespace package
{
namespace
{
/// A whole layer of a plain page, or a tile with all its levels inside a tiled one.
bool liesInPage(const gpu::TextureRef& t, const lumicut::fb::TexturePage& page)
{
    const uint32_t x = t.origin & 0xffff, y = t.origin >> 16, width = t.size & 0xffff, height = t.size >> 16;
    if (page.tiled() != ((t.sampling & gpu::kSampleTile) != 0))
        return false;
    if (!page.tiled())
        return t.origin == 0 && width == page.width() && height == page.height();
    if (x % 4 != 0 || y % 4 != 0 || width == 0 || height == 0)
        return false;
    const auto levels = uint32_t(std::bit_width(std::max(width, height)));
    for (uint32_t level = 0; level < levels; ++level)
        if (gpu::tileLevelX(x, width, level) + gpu::tileSide(gpu::levelSide(width, level)) > page.width() ||
            gpu::tileLevelY(y, height, level) + gpu::tileSide(gpu::levelSide(height, level)) > page.height())
            return false;
    return true;
}

std::string range(float least, float most)
{
    if (most < gpu::kUnbounded)
        return fmt::format("{} to {}", least, most);
    return least == -gpu::kUnbounded ? "the finite numbers" : fmt::format("{} to infinity", least);
}

/// Every component in its range, and finite.
Status verifyFactors(const gpu::Material& m, size_t index)
{
    using gpu::kUnbounded;
#define NUMBER(word, type, name, default_, least, most, meaning) \
    if (!isWithin(m.name, least, most)) \
        return invalid("chunk MATL: material {} has {} outside {}", index, #name, range(least, most));
#define FLAGS(word, name, meaning)
#define TEXTURE(word, name, encoding, channels, feature, meaning)
    MATERIAL_FIELDS(NUMBER, FLAGS, TEXTURE)
#undef NUMBER
#undef FLAGS
#undef TEXTURE
    if (m.ior != 0 && m.ior < 1)
        return invalid("chunk MATL: material {} has an index of refraction between 0 and 1", index);
    return Success{};
}
} // namespace

Status verifyMaterials(const Contents& contents)
{
    constexpr uint32_t kAlphaModes = gpu::kMaterialAlphaMask | gpu::kMaterialAlphaBlend;
    constexpr uint32_t kAllFlags = kAlphaModes | gpu::kMaterialDoubleSided | gpu::kMaterialUnlit | gpu::kMaterialThin;
    for (size_t i = 0; i < contents.materials.size(); ++i)
    {
        const gpu::Material& m = contents.materials[i];
        if (Status factors = verifyFactors(m, i); !factors)
            return factors;
        if ((m.flags & ~kAllFlags) != 0 || (m.flags & kAlphaModes) == kAlphaModes)
            return invalid("chunk MATL: material {} has unknown or contradictory flags ({:#x})", i, m.flags);
        for (const MaterialTexture& texture : kMaterialTextures)
        {
            if (const uint32_t ref = m.*texture.index; ref != gpu::kNone && ref >= contents.texture_refs.size())
                return invalid("chunk MATL: material {} refers to texture {} as its {}, chunk TREF has {}", i, ref,
                               texture.name, contents.texture_refs.size());
        }
    }
    return Success{};
}

Status verifyTextureRefs(const Contents& contents)
{
    const auto& pages = *contents.meta->texture_pages();
    for (size_t i = 0; i < contents.texture_refs.size(); ++i)
    {
        const gpu::TextureRef& t = contents.texture_refs[i];
        if (t.page >= pages.size())
            return invalid("chunk TREF: texture {} refers to page {}, there are {}", i, t.page, pages.size());
        if (t.layer >= pages.Get(t.page)->layers())
            return invalid("chunk TREF: texture {} refers to layer {} of page {}, which has {}", i, t.layer, t.page,
                           pages.Get(t.page)->layers());
        if ((t.sampling & 3) > gpu::kWrapMirror || (t.sampling >> 2 & 3) > gpu::kWrapMirror ||
            t.sampling >= 2 * gpu::kSampleNormalXy)
            return invalid("chunk TREF: texture {} has unknown sampling bits ({:#x})", i, t.sampling);
        if (!liesInPage(t, *pages.Get(t.page)))
            return invalid("chunk TREF: texture {} is not where page {} holds textures", i, t.page);
        if (!isFinite(t.u_row) || !isFinite(t.v_row))
            return invalid("chunk TREF: texture {} has a coordinate transform that is not finite", i);
    }
    return Success{};
}
} // namespace package
