#include "compiler/emission_average.h"

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

/// Texture coordinate to texel index by the wrap mode's rule (nearest).
uint32_t wrap(float coordinate, uint32_t size, uint32_t mode)
{
    float t = coordinate;
    if (mode == gpu::kWrapRepeat)
        t -= std::floor(t);
    else if (mode == gpu::kWrapMirror)
        t = 1 - std::abs(t - 2 * std::floor(t / 2) - 1);
    return uint32_t(std::clamp(t * float(size), 0.0f, float(size - 1)));
}

gpu::vec3 fetch(const TextureImage& image, const TextureUse& use, const gpu::vec2& uv)
{
    const uint32_t x = wrap(uv.x, image.width, use.sampling & 3);
    const uint32_t y = wrap(uv.y, image.height, use.sampling >> 2 & 3);
    const uint8_t* texel = image.texels.data() + 4 * (size_t(y) * image.width + x);
    if (image.srgb)
        return {decodeSrgb(texel[0]), decodeSrgb(texel[1]), decodeSrgb(texel[2])};
    return {float(texel[0]) / 255, float(texel[1]) / 255, float(texel[2]) / 255};
}

gpu::vec2 transformedUv(const TextureUse& use, const gpu::VertexAttributes& vertex)
{
    const gpu::vec2 uv = (use.sampling & gpu::kSampleUv1) != 0 ? vertex.uv1 : vertex.uv0;
    const gpu::vec3 homogeneous{uv.x, uv.y, 1};
    return {dot(use.u_row, homogeneous), dot(use.v_row, homogeneous)};
}

uint32_t subdivisions(const TextureImage& image, const std::array<gpu::vec2, 3>& uv)
{
    float longest = 0; // edge, in texels
    for (size_t i = 0; i < 3; ++i)
    {
        const gpu::vec2& a = uv[i];
        const gpu::vec2& b = uv[(i + 1) % 3];
        longest =
            std::max({longest, std::abs(a.x - b.x) * float(image.width), std::abs(a.y - b.y) * float(image.height)});
    }
    return uint32_t(std::clamp(std::ceil(longest), 4.0f, 128.0f));
}
} // namespace

gpu::vec3 averageEmissiveTexture(const SceneData& scene, uint32_t triangle)
{
    const gpu::Material& material = scene.materials[scene.mesh.materials[triangle]];
    const TextureUse& use = scene.texture_uses[material.emissive_texture];
    const TextureImage& image = scene.images[use.image];
    const gpu::uvec3& v = scene.mesh.triangles[triangle];
    const std::array<gpu::vec2, 3> uv{transformedUv(use, scene.mesh.attributes[v.x]),
                                      transformedUv(use, scene.mesh.attributes[v.y]),
                                      transformedUv(use, scene.mesh.attributes[v.z])};

    // Centroids of the n^2 congruent parts: i, j count thirds of the part's size.
    const uint32_t n = subdivisions(image, uv);
    gpu::vec3 sum{};
    const auto add = [&](uint32_t i, uint32_t j)
    {
        const float b1 = float(i) / float(3 * n);
        const float b2 = float(j) / float(3 * n);
        const float b0 = 1 - b1 - b2;
        sum = sum + fetch(image, use,
                          {b0 * uv[0].x + b1 * uv[1].x + b2 * uv[2].x, b0 * uv[0].y + b1 * uv[1].y + b2 * uv[2].y});
    };
    for (uint32_t i = 0; i < n; ++i)
    {
        for (uint32_t j = 0; i + j < n; ++j)
        {
            add(3 * i + 1, 3 * j + 1);
            if (i + j + 1 < n)
                add(3 * i + 2, 3 * j + 2);
        }
    }
    return sum * (1 / float(n * n));
}
