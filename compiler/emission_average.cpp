#include "compiler/emission_average.h"

#include "compiler/mapped_texture.h"
#include "compiler/vector_math.h"

#include <array>

namespace
{
float decodeSrgb(uint8_t value)
{
    static const std::array<float, 256> kTable = []
    {
        std::array<float, 256> table{};
        for (size_t i = 0; i < table.size(); ++i)
        {
            const float s = float(i) / 255;
            table[i] = s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
        }
        return table;
    }();
    return kTable[value];
}

uint32_t subdivisions(const MappedTexture& texture)
{
    float longest = 0; // edge, in texels
    for (size_t i = 0; i < 3; ++i)
    {
        const gpu::vec2& a = texture.uv[i];
        const gpu::vec2& b = texture.uv[(i + 1) % 3];
        longest = std::max({longest, std::abs(a.x - b.x) * float(texture.image.width),
                            std::abs(a.y - b.y) * float(texture.image.height)});
    }
    return uint32_t(std::clamp(std::ceil(longest), 4.0f, 128.0f));
}
} // namespace

gpu::vec3 averageEmissiveTexture(const SceneData& scene, uint32_t triangle)
{
    const gpu::Material& material = scene.materials[scene.mesh.materials[triangle]];
    const MappedTexture texture = mapTexture(scene, material.emissive_texture, triangle);
    const uint32_t n = subdivisions(texture);
    gpu::vec3 sum{};
    forEachPart(n,
                [&](const std::array<float, 3>& at)
                {
                    const uint8_t* texel = texelAt(texture, at);
                    const auto linear = [&](size_t i)
                    { return texture.image.srgb ? decodeSrgb(texel[i]) : float(texel[i]) / 255; };
                    sum = sum + gpu::vec3{linear(0), linear(1), linear(2)};
                });
    return sum * (1 / float(n * n));
}
