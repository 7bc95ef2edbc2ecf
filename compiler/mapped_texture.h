// A texture as it lies on a triangle.
#pragma once
#include "compiler/scene_data.h"

#include <array>

struct MappedTexture
{
    const TextureUse& use;
    const TextureImage& image;
    std::array<gpu::vec2, 3> uv; // of the corners, transformed as the use says
};

/// @param use index into scene.texture_uses
MappedTexture mapTexture(const SceneData& scene, uint32_t use, uint32_t triangle);

/// The texel at a point of the triangle, by the nearest one and the wrap modes. @return RGBA as the file stores it
const uint8_t* texelAt(const MappedTexture& texture, const std::array<float, 3>& barycentrics);

/// Visits the centroids of the n^2 congruent parts of a triangle. @param visit is called with barycentrics
template <typename Visit>
void forEachPart(uint32_t n, const Visit& visit)
{
    const auto at = [&](uint32_t i, uint32_t j) // in thirds of a part's size
    {
        const float b1 = float(i) / float(3 * n), b2 = float(j) / float(3 * n);
        visit(std::array<float, 3>{1 - b1 - b2, b1, b2});
    };
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t j = 0; i + j < n; ++j)
        {
            at(3 * i + 1, 3 * j + 1);
            if (i + j + 1 < n)
                at(3 * i + 2, 3 * j + 2);
        }
}
