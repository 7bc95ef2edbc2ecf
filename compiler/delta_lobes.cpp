#include "compiler/delta_lobes.h"

#include "compiler/mapped_texture.h"
#include "compiler/vector_math.h"

namespace
{
constexpr double kSamples = 65536;        // a material: shares of kLeastSmoothShare are six or seven of them
constexpr float kDielectricAlbedo = 0.1f; // of a smooth surface of glass under even light; 0.09 by Fresnel's formulas

/// What of a material's area a delta lobe covers, and what part of even light the lobe sends on, both of the whole.
struct Part
{
    double smooth = 0, sent = 0;
};

/// A roughness: a factor times the green channel of a texture.
struct Roughness
{
    float factor;
    uint32_t texture; // into SceneData::texture_uses, or gpu::kNone
};

double areaOf(const WorldMesh& mesh, uint32_t triangle)
{
    const gpu::uvec3& v = mesh.triangles[triangle];
    const gpu::vec3& a = mesh.positions[v.x];
    return 0.5 * double(length(cross(mesh.positions[v.y] - a, mesh.positions[v.z] - a)));
}

double areaOf(const WorldMesh& mesh, const std::vector<uint32_t>& triangles)
{
    double total = 0;
    for (const uint32_t triangle : triangles)
        total += areaOf(mesh, triangle);
    return total;
}

std::vector<std::vector<uint32_t>> trianglesByMaterial(const SceneData& scene)
{
    std::vector<std::vector<uint32_t>> triangles(scene.materials.size());
    for (uint32_t i = 0; i < scene.mesh.triangles.size(); ++i)
        triangles[scene.mesh.materials[i]].push_back(i);
    return triangles;
}

/// @param total area of the triangles, @param sent_at what a smooth lobe sends on where the texture is `texel`
template <typename SentAt>
Part smoothPart(const SceneData& scene, const std::vector<uint32_t>& triangles, double total,
                const Roughness& roughness, const SentAt& sent_at)
{
    constexpr uint8_t kWhite[4] = {255, 255, 255, 255};
    if (roughness.factor < gpu::kSmoothRoughness)
        return {1, sent_at(kWhite)};
    if (roughness.texture == gpu::kNone)
        return {};
    if (!(total > 0))
        return {1, sent_at(kWhite)}; // nothing at rest; it may grow
    Part part;
    for (const uint32_t triangle : triangles)
    {
        const double area = areaOf(scene.mesh, triangle);
        const MappedTexture texture = mapTexture(scene, roughness.texture, triangle);
        const auto n = uint32_t(std::max(1.0, std::ceil(std::sqrt(kSamples * area / total))));
        const double weight = area / (double(n) * n * total);
        forEachPart(n,
                    [&](const std::array<float, 3>& at)
                    {
                        const uint8_t* texel = texelAt(texture, at);
                        if (roughness.factor * (float(texel[1]) / 255) >= gpu::kSmoothRoughness)
                            return;
                        part.smooth += weight;
                        part.sent += weight * double(sent_at(texel));
                    });
    }
    return part;
}

/// What the lobe of a metal, glass or plastic sends on. @param texel of the texture of metal and roughness, if any
float sentBySurface(const gpu::Material& m, const uint8_t* texel)
{
    const float metallic = m.metallic * float(texel[2]) / 255;
    const float dielectric = m.transmission > 0 ? 1 : std::min(1.0f, m.specular) * kDielectricAlbedo;
    return metallic + (1 - metallic) * dielectric;
}
} // namespace

DeltaLobes findDeltaLobes(const SceneData& scene)
{
    const std::vector<std::vector<uint32_t>> triangles = trianglesByMaterial(scene);
    DeltaLobes found;
    double area_sum = 0, sent_sum = 0;
    for (size_t i = 0; i < scene.materials.size(); ++i)
    {
        const gpu::Material& m = scene.materials[i];
        if (triangles[i].empty() || (m.flags & gpu::kMaterialUnlit) != 0)
            continue;
        const double area = areaOf(scene.mesh, triangles[i]);
        area_sum += area;
        const auto add = [&](const Roughness& roughness, const auto& sent_at)
        {
            const Part part = smoothPart(scene, triangles[i], area, roughness, sent_at);
            sent_sum += area * part.sent;
            found.seen = found.seen || part.smooth > kLeastSmoothShare;
        };
        if (m.specular > 0 || m.metallic > 0 || m.transmission > 0)
            add({m.roughness, m.metallic_roughness_texture},
                [&](const uint8_t* texel) { return sentBySurface(m, texel); });
        if (m.clearcoat > 0)
            add({m.clearcoat_roughness, m.clearcoat_roughness_texture},
                [&](const uint8_t*) { return m.clearcoat * kDielectricAlbedo; });
    }
    found.matter = found.seen && sent_sum >= kLeastSent * area_sum;
    return found;
}
