#include "compiler/texture_role.h"

#include "format/check.h"
#include "format/material.h"

namespace
{
/// Collects what the uses of each image have in common.
class Roles
{
public:
    Roles(std::span<const TextureUse> uses, size_t image_count) : uses_(uses), roles_(image_count), read_(uses.size())
    {
    }

    void read(uint32_t use, uint32_t channels, bool normal = false, bool covers = false)
    {
        if (use == gpu::kNone)
            return;
        check(use < uses_.size(), "texture use {} of {}", use, uses_.size());
        read_[use] = true;
        TextureRole& role = roles_[uses_[use].image];
        const bool first = role.channels == 0;
        role.normal = normal && (first || role.normal);
        role.covers = covers && (first || role.covers);
        role.channels |= channels;
    }
    void test(uint32_t use, float cutoff)
    {
        if (use != gpu::kNone && roles_[uses_[use].image].coverage_cutoff == 0)
            roles_[uses_[use].image].coverage_cutoff = cutoff;
    }
    std::vector<TextureRole> take()
    {
        for (uint32_t use = 0; use < uses_.size(); ++use)
            if (!read_[use])
                read(use, kAllChannels);
        return std::move(roles_);
    }

private:
    std::span<const TextureUse> uses_;
    std::vector<TextureRole> roles_;
    std::vector<bool> read_;
};
} // namespace

std::vector<TextureRole> textureRoles(std::span<const gpu::Material> materials, std::span<const TextureUse> uses,
                                      size_t image_count)
{
    Roles roles(uses, image_count);
    for (const gpu::Material& m : materials)
    {
        const bool masked = (m.flags & gpu::kMaterialAlphaMask) != 0;
        const bool covers = masked || (m.flags & gpu::kMaterialAlphaBlend) != 0;
        for (const package::MaterialTexture& texture : package::kMaterialTextures)
        {
            const bool colored = texture.index == &gpu::Material::base_color_texture;
            roles.read(m.*texture.index, texture.channels | (colored && covers ? gpu::kAlpha : 0u),
                       texture.encoding == gpu::kEncodingNormal, colored && covers);
        }
        if (masked && m.alpha > 0)
            roles.test(m.base_color_texture, m.alpha_cutoff / m.alpha);
    }
    return roles.take();
}
