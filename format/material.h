// What follows from the list of material fields in C++.
#pragma once
#include "format/gpu_scene.h"

#include <array>
#include <cstdint>

namespace package
{
/// glTF's default material: every number at its default, no flags, no textures.
gpu::Material defaultMaterial();

struct MaterialTexture
{
    const char* name;
    uint32_t gpu::Material::*index; // into TextureRefs, or gpu::kNone
    uint32_t encoding;              // gpu::kEncoding*
    uint32_t channels;              // gpu::kRed ..: that are read, alpha coverage apart
    uint32_t feature;               // gpu::kFeature*: what a scene with it has
};

/// The textures that a material may have, in the order of their words.
inline constexpr auto kMaterialTextures = []
{
    using namespace gpu;
    return std::array{
#define NUMBER(word, type, name, default_, least, most, meaning)
#define FLAGS(word, name, meaning)
#define TEXTURE(word, name, encoding, channels, feature, meaning) \
    MaterialTexture{#name, &gpu::Material::name, encoding, channels, feature},
        MATERIAL_FIELDS(NUMBER, FLAGS, TEXTURE)
#undef NUMBER
#undef FLAGS
#undef TEXTURE
    };
}();
} // namespace package
