#include "compiler/mapped_texture.h"

#include "compiler/vector_math.h"

namespace
{
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

gpu::vec2 transformedUv(const TextureUse& use, const gpu::VertexAttributes& vertex)
{
    const gpu::vec2 uv = (use.sampling & gpu::kSampleUv1) != 0 ? vertex.uv1 : vertex.uv0;
    const gpu::vec3 homogeneous{uv.x, uv.y, 1};
    return {dot(use.u_row, homogeneous), dot(use.v_row, homogeneous)};
}
} // namespace

MappedTexture mapTexture(const SceneData& scene, uint32_t use, uint32_t triangle)
{
    const TextureUse& used = scene.texture_uses[use];
    const gpu::uvec3& v = scene.mesh.triangles[triangle];
    const auto& attributes = scene.mesh.attributes;
    return {used,
            scene.images[used.image],
            {transformedUv(used, attributes[v.x]), transformedUv(used, attributes[v.y]),
             transformedUv(used, attributes[v.z])}};
}

const uint8_t* texelAt(const MappedTexture& texture, const std::array<float, 3>& b)
{
    const auto& uv = texture.uv;
    const TextureImage& image = texture.image;
    const uint32_t x = wrap(b[0] * uv[0].x + b[1] * uv[1].x + b[2] * uv[2].x, image.width, texture.use.sampling & 3);
    const uint32_t y =
        wrap(b[0] * uv[0].y + b[1] * uv[1].y + b[2] * uv[2].y, image.height, texture.use.sampling >> 2 & 3);
    return image.texels.data() + 4 * (size_t(y) * image.width + x);
}
