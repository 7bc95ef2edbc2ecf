#include "tools/scenes/atrium_materials.h"

namespace
{

struct TextureUse
{
    uint32_t color, normal;
    std::optional<uint32_t> roughness;
};

TextureUse addTextures(GltfWriter& gltf, const std::string& name, const SurfaceTextures& textures)
{
    TextureUse use{gltf.addTexture(name, textures.color), gltf.addTexture(name + " normal", textures.normal),
                   std::nullopt};
    if (textures.roughness.size != 0)
        use.roughness = gltf.addTexture(name + " roughness", textures.roughness);
    return use;
}

uint32_t addTextured(GltfWriter& gltf, const std::string& name, const TextureUse& use, float roughness,
                     float normal_scale, Vec3 tint = {1, 1, 1}, bool double_sided = false)
{
    MaterialDescription material;
    material.name = name;
    material.base_color = tint;
    material.roughness = roughness;
    material.base_color_texture = use.color;
    material.normal_texture = use.normal;
    material.metallic_roughness_texture = use.roughness;
    material.normal_scale = normal_scale;
    material.double_sided = double_sided;
    if (use.roughness)
        material.metallic = 1; // times the texture's 0
    return gltf.addMaterial(material);
}

uint32_t addPlain(GltfWriter& gltf, const std::string& name, Vec3 color, float metallic, float roughness)
{
    MaterialDescription material;
    material.name = name;
    material.base_color = color;
    material.metallic = metallic;
    material.roughness = roughness;
    return gltf.addMaterial(material);
}

uint32_t addGlowing(GltfWriter& gltf, const std::string& name, Vec3 radiance)
{
    MaterialDescription material;
    material.name = name;
    material.base_color = {0, 0, 0};
    material.lambert = true;
    material.emission = radiance;
    return gltf.addMaterial(material);
}

} // namespace

AtriumMaterials addAtriumMaterials(GltfWriter& gltf)
{
    AtriumMaterials m{};
    m.tiles = addTextured(gltf, "marble tiles", addTextures(gltf, "marble tiles", marbleTiles(1024)), 1, 1);
    m.brick = addTextured(gltf, "brick", addTextures(gltf, "brick", bricks(512)), 0.9f, 1);
    m.plaster = addTextured(gltf, "plaster", addTextures(gltf, "plaster", plaster(512)), 0.95f, 1);
    m.limestone = addTextured(gltf, "limestone", addTextures(gltf, "limestone", limestone(512)), 0.8f, 1);
    m.planks = addTextured(gltf, "planks", addTextures(gltf, "planks", planks(512)), 0.7f, 1);
    const TextureUse weave = addTextures(gltf, "woven cloth", wovenCloth(512));
    const Vec3 dyes[3] = {{0.72f, 0.045f, 0.035f}, {0.05f, 0.36f, 0.10f}, {0.05f, 0.13f, 0.58f}};
    const char* const names[3] = {"red cloth", "green cloth", "blue cloth"};
    for (int i = 0; i < 3; ++i)
        m.cloth[i] = addTextured(gltf, names[i], weave, 0.9f, 0.6f, dyes[i], true);
    m.bronze = addPlain(gltf, "bronze", {0.42f, 0.28f, 0.15f}, 1, 0.35f);
    m.gold = addPlain(gltf, "polished gold", {1.0f, 0.77f, 0.34f}, 1, 0.08f);
    m.mirror = addPlain(gltf, "mirror", {0.94f, 0.95f, 0.95f}, 1, 0);
    m.water = addPlain(gltf, "dark water", {0.015f, 0.035f, 0.04f}, 0, 0.02f);
    m.marble = addPlain(gltf, "white marble", {0.68f, 0.66f, 0.62f}, 0, 0.3f);

    MaterialDescription glass;
    glass.name = "glass";
    glass.roughness = 0;
    glass.transmission = 1;
    glass.thickness = 0.3f;
    glass.attenuation_color = Vec3{0.80f, 0.93f, 0.90f};
    glass.attenuation_distance = 0.5f;
    m.glass = gltf.addMaterial(glass);
    MaterialDescription pane;
    pane.name = "tinted pane";
    pane.base_color = {0.62f, 0.86f, 0.80f};
    pane.roughness = 0;
    pane.transmission = 1;
    m.pane = gltf.addMaterial(pane);

    m.sky = addGlowing(gltf, "sky", {2.6f, 3.3f, 4.4f});
    m.lamp = addGlowing(gltf, "lamp", {190, 112, 48});
    return m;
}
