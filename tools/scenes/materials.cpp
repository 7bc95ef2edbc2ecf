#include "tools/scenes/scenes.h"

namespace
{
using Extensions = nlohmann::ordered_json;

constexpr float kRadius = 0.11f, kStep = 0.26f; // metres

uint32_t wallMaterial(GltfWriter& gltf, const char* name, Vec3 color)
{
    MaterialDescription wall;
    wall.name = name;
    wall.base_color = color;
    wall.lambert = true;
    return gltf.addMaterial(wall);
}

uint32_t lampMaterial(GltfWriter& gltf, const char* name, Vec3 emission)
{
    MaterialDescription lamp;
    lamp.name = name;
    lamp.base_color = {0, 0, 0};
    lamp.lambert = true;
    lamp.emission = emission;
    return gltf.addMaterial(lamp);
}

/// The spheres' materials, a row after another.
std::vector<MaterialDescription> layered()
{
    const auto described = [](const char* name, Vec3 color, float metallic, float roughness, Extensions extensions)
    {
        MaterialDescription m;
        m.name = name;
        m.base_color = color;
        m.metallic = metallic;
        m.roughness = roughness;
        m.extensions = std::move(extensions);
        return m;
    };
    MaterialDescription prism =
        described("dispersion", {1, 1, 1}, 0, 0, {{"KHR_materials_dispersion", {{"dispersion", 3}}}});
    prism.transmission = 1;
    prism.thickness = 2 * kRadius;
    prism.ior = 1.7f;
    return {
        described("smooth coat", {0.55f, 0.02f, 0.02f}, 0, 0.6f,
                  {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}}),
        described("rough coat", {0.02f, 0.15f, 0.5f}, 0.8f, 0.5f,
                  {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", 0.2}}}}),
        described("sheen", {0.03f, 0.05f, 0.2f}, 0, 1,
                  {{"KHR_materials_sheen", {{"sheenColorFactor", {0.6, 0.65, 0.9}}, {"sheenRoughnessFactor", 0.4}}}}),
        described("plain", {0.5f, 0.5f, 0.5f}, 0, 0.5f, {}),
        described("brushed", {0.9f, 0.75f, 0.5f}, 1, 0.25f,
                  {{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.8}}}}),
        described("film", {0.7f, 0.7f, 0.7f}, 1, 0.1f,
                  {{"KHR_materials_iridescence",
                    {{"iridescenceFactor", 1}, {"iridescenceIor", 1.4}, {"iridescenceThicknessMaximum", 420}}}}),
        prism,
        described("wax", {0.2f, 0.5f, 0.1f}, 0, 0.8f,
                  {{"KHR_materials_diffuse_transmission",
                    {{"diffuseTransmissionFactor", 0.7}, {"diffuseTransmissionColorFactor", {0.4, 0.8, 0.2}}}}}),
    };
}
} // namespace

GltfWriter materialsScene()
{
    GltfWriter gltf;
    Mesh ground, walls;
    addQuad(ground, {-1.2f, 0, 1.2f}, {2.4f, 0, 0}, {0, 0, -2.4f});
    addQuad(walls, {-1.2f, 0, -1.2f}, {2.4f, 0, 0}, {0, 1.6f, 0});
    addQuad(walls, {1.2f, 0, 1.2f}, {-2.4f, 0, 0}, {0, 1.6f, 0});
    addQuad(walls, {-1.2f, 0, 1.2f}, {0, 0, -2.4f}, {0, 1.6f, 0});
    addQuad(walls, {1.2f, 0, -1.2f}, {0, 0, 2.4f}, {0, 1.6f, 0});
    addQuad(walls, {-1.2f, 1.6f, -1.2f}, {2.4f, 0, 0}, {0, 0, 2.4f});
    gltf.add("ground", ground, wallMaterial(gltf, "ground", {0.45f, 0.43f, 0.4f}));
    gltf.add("walls", walls, wallMaterial(gltf, "walls", {0.7f, 0.7f, 0.7f}));

    Mesh panel, spot; // a broad light above, a small one behind: it shines through what is translucent
    addQuad(panel, {-0.5f, 1.59f, -0.3f}, {1.0f, 0, 0}, {0, 0, 0.5f});
    addQuad(spot, {-0.1f, 1.3f, -1.19f}, {0.2f, 0, 0}, {0, 0.2f, 0});
    gltf.add("panel", panel, lampMaterial(gltf, "panel", {12, 12, 12}));
    gltf.add("spot", spot, lampMaterial(gltf, "spot", {90, 85, 75}));

    const Mesh ball = sphere(kRadius, 96, 48);
    const std::vector<MaterialDescription> materials = layered();
    for (size_t i = 0; i < materials.size(); ++i)
    {
        const float column = float(i % 4) - 1.5f, row = i < 4 ? -0.22f : 0.12f;
        gltf.addNode(materials[i].name, gltf.addMesh(materials[i].name, ball, gltf.addMaterial(materials[i])),
                     {column * kStep, kRadius + 5e-4f, row});
    }
    gltf.addCamera("row", {0, 0.62f, 1.1f}, {0, 0.1f, -0.06f}, 0.62f);
    return gltf;
}
