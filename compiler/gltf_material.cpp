#include "compiler/gltf_material.h"

#include "compiler/linear.h"
#include "format/material.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <map>
#include <set>
#include <utility>

namespace
{
using tinygltf::Value;

double number(const Value& object, const char* key, double fallback)
{
    const Value& value = object.Get(key);
    return value.IsNumber() && std::isfinite(value.GetNumberAsDouble()) ? value.GetNumberAsDouble() : fallback;
}

gpu::vec3 color(const Value& object, const char* key, gpu::vec3 fallback)
{
    const Value& value = object.Get(key);
    if (!value.IsArray() || value.ArrayLen() < 3)
        return fallback;
    float rgb[3];
    for (int i = 0; i < 3; ++i)
    {
        if (!value.Get(i).IsNumber())
            return fallback;
        rgb[i] = float(value.Get(i).GetNumberAsDouble());
    }
    const gpu::vec3 c{rgb[0], rgb[1], rgb[2]};
    return isFinite(c) ? c : fallback;
}

gpu::vec3 color(const std::vector<double>& rgb, gpu::vec3 fallback)
{
    if (rgb.size() < 3)
        return fallback;
    const gpu::vec3 c{float(rgb[0]), float(rgb[1]), float(rgb[2])};
    return isFinite(c) ? c : fallback;
}

gpu::vec3 nonNegative(gpu::vec3 c)
{
    return {std::max(c.x, 0.0f), std::max(c.y, 0.0f), std::max(c.z, 0.0f)};
}
float unitRange(double v)
{
    return std::isfinite(v) ? float(std::clamp(v, 0.0, 1.0)) : 1.0f;
}

gpu::vec3 unitRange(gpu::vec3 c)
{
    return {unitRange(c.x), unitRange(c.y), unitRange(c.z)};
}
bool isBlack(gpu::vec3 c)
{
    return c.x == 0 && c.y == 0 && c.z == 0;
}

uint32_t wrapMode(int gltf_wrap)
{
    return gltf_wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? gpu::kWrapClamp
           : gltf_wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? gpu::kWrapMirror
                                                                : gpu::kWrapRepeat;
}

/// Reads texture references, which repairGltf() has checked: their textures and images exist.
class TextureReader
{
public:
    TextureReader(const GltfFile& file, SceneData& scene, std::vector<ImageRequest>& requests)
        : file_(file), scene_(scene), requests_(requests)
    {
    }

    /// @return index into SceneData::texture_uses, or gpu::kNone
    uint32_t use(int texture, int tex_coord, const tinygltf::ExtensionMap& extensions, bool srgb)
    {
        const int image = sourceImage(texture);
        if (image < 0)
            return gpu::kNone;
        TextureUse result;
        result.image = request({image, srgb});
        const auto transform = extensions.find("KHR_texture_transform");
        if (transform != extensions.end())
            tex_coord = applyTransform(transform->second, result, tex_coord);
        result.sampling = sampling(file_.model.textures[size_t(texture)].sampler);
        if (tex_coord == 1)
            result.sampling |= gpu::kSampleUv1;
        if (tex_coord > 1)
            unsupported_tex_coord_ = true;
        scene_.texture_uses.push_back(result);
        return uint32_t(scene_.texture_uses.size() - 1);
    }

    uint32_t use(const Value& info, bool srgb)
    {
        if (!info.IsObject() || !info.Get("index").IsInt())
            return gpu::kNone;
        tinygltf::ExtensionMap extensions;
        if (const Value& map = info.Get("extensions"); map.IsObject())
            extensions = map.Get<Value::Object>();
        const Value& tex_coord = info.Get("texCoord");
        return use(info.Get("index").GetNumberAsInt(), tex_coord.IsInt() ? tex_coord.GetNumberAsInt() : 0, extensions,
                   srgb);
    }

    bool unsupportedTexCoord() const { return unsupported_tex_coord_; }

private:
    int sourceImage(int texture)
    {
        if (texture == -1)
            return -1;
        const auto& textures = file_.model.textures;
        int source = textures[size_t(texture)].source;
        const auto webp = textures[size_t(texture)].extensions.find("EXT_texture_webp");
        if (webp != textures[size_t(texture)].extensions.end() && webp->second.Get("source").IsInt())
            source = webp->second.Get("source").GetNumberAsInt();
        const auto ktx2 = textures[size_t(texture)].extensions.find("KHR_texture_basisu");
        if (source < 0 && ktx2 != textures[size_t(texture)].extensions.end() && ktx2->second.Get("source").IsInt())
            source = ktx2->second.Get("source").GetNumberAsInt();
        if (source == -1 && reported_.insert(texture).second) // allowed: an extension that is not supported may hold it
            scene_.warnings.push_back({WarningKind::kLeftOut, fmt::format("/textures/{}", texture),
                                       "a texture names no image of a kind that can be read (PNG, JPEG, WebP, KTX2)",
                                       "its materials go without it"});
        return source;
    }

    uint32_t request(ImageRequest wanted)
    {
        const auto found = std::find(requests_.begin(), requests_.end(), wanted);
        if (found != requests_.end())
            return uint32_t(found - requests_.begin());
        requests_.push_back(wanted);
        return uint32_t(requests_.size() - 1);
    }

    /// uv' = translation * rotation * scale * uv. @return the coordinate set to use
    static int applyTransform(const Value& transform, TextureUse& use, int tex_coord)
    {
        const auto pair = [&](const char* key, float fallback)
        {
            const Value& v = transform.Get(key);
            const auto at = [&](int i)
            { return v.IsArray() && v.Get(i).IsNumber() ? float(v.Get(i).GetNumberAsDouble()) : fallback; };
            return gpu::vec2{at(0), at(1)};
        };
        const gpu::vec2 offset = pair("offset", 0);
        const gpu::vec2 scale = pair("scale", 1);
        const double rotation = number(transform, "rotation", 0);
        const float c = float(std::cos(rotation));
        const float s = float(std::sin(rotation));
        const gpu::vec3 u_row{c * scale.x, s * scale.y, offset.x};
        const gpu::vec3 v_row{-s * scale.x, c * scale.y, offset.y};
        if (isFinite(u_row) && isFinite(v_row))
        {
            use.u_row = u_row;
            use.v_row = v_row;
        }
        const Value& override_set = transform.Get("texCoord");
        return override_set.IsInt() ? override_set.GetNumberAsInt() : tex_coord;
    }

    uint32_t sampling(int sampler) const
    {
        if (sampler < 0 || size_t(sampler) >= file_.model.samplers.size())
            return 0;
        const tinygltf::Sampler& s = file_.model.samplers[size_t(sampler)];
        return wrapMode(s.wrapS) | wrapMode(s.wrapT) << 2 |
               (s.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST ? gpu::kSampleNearest : 0u);
    }

    const GltfFile& file_;
    SceneData& scene_;
    std::vector<ImageRequest>& requests_;
    std::set<int> reported_; // textures without an image
    bool unsupported_tex_coord_ = false;
};

void readCore(const tinygltf::Material& from, TextureReader& textures, gpu::Material& m)
{
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    m.base_color = nonNegative(color(pbr.baseColorFactor, {1, 1, 1}));
    m.alpha = pbr.baseColorFactor.size() == 4 ? unitRange(pbr.baseColorFactor[3]) : 1.0f;
    m.metallic = unitRange(pbr.metallicFactor);
    m.roughness = unitRange(pbr.roughnessFactor);
    m.base_color_texture =
        textures.use(pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord, pbr.baseColorTexture.extensions, true);
    m.metallic_roughness_texture =
        textures.use(pbr.metallicRoughnessTexture.index, pbr.metallicRoughnessTexture.texCoord,
                     pbr.metallicRoughnessTexture.extensions, false);
    m.normal_texture =
        textures.use(from.normalTexture.index, from.normalTexture.texCoord, from.normalTexture.extensions, false);
    m.normal_scale = std::isfinite(from.normalTexture.scale) ? float(from.normalTexture.scale) : 1.0f;
    if (from.alphaMode == "MASK")
        m.flags |= gpu::kMaterialAlphaMask;
    else if (from.alphaMode == "BLEND")
        m.flags |= gpu::kMaterialAlphaBlend;
    m.alpha_cutoff = std::isfinite(from.alphaCutoff) ? float(from.alphaCutoff) : 0.5f;
    if (from.doubleSided)
        m.flags |= gpu::kMaterialDoubleSided;
}

void readEmission(const tinygltf::Material& from, const Value* strength, TextureReader& textures, gpu::Material& m)
{
    const double factor = strength == nullptr ? 1 : std::max(number(*strength, "emissiveStrength", 1), 0.0);
    m.emission = nonNegative(color(from.emissiveFactor, {0, 0, 0})) * float(factor);
    if (m.emission.x > 0 || m.emission.y > 0 || m.emission.z > 0)
        m.emissive_texture = textures.use(from.emissiveTexture.index, from.emissiveTexture.texCoord,
                                          from.emissiveTexture.extensions, true);
    if (from.emissiveTexture.index != -1 && m.emissive_texture == gpu::kNone)
        m.emission = {}; // without its texture, all of the surface would emit
}

void readTransmission(const Value& transmission, const Value* volume, TextureReader& textures, gpu::Material& m)
{
    m.transmission = unitRange(number(transmission, "transmissionFactor", 0));
    if (m.transmission == 0)
        return;
    m.transmission_texture = textures.use(transmission.Get("transmissionTexture"), false);
    if (volume == nullptr || !(number(*volume, "thicknessFactor", 0) > 0))
    {
        m.flags |= gpu::kMaterialThin;
        return;
    }
    const double distance = number(*volume, "attenuationDistance", 0); // absent: infinite, nothing is absorbed
    const gpu::vec3 tint = color(*volume, "attenuationColor", {1, 1, 1});
    const auto absorption = [&](float c) { return float(-std::log(std::clamp(double(c), 1e-6, 1.0)) / distance); };
    if (distance > 0)
        m.absorption = {absorption(tint.x), absorption(tint.y), absorption(tint.z)};
}

void readSpecular(const Value& specular, TextureReader& textures, gpu::Material& m)
{
    m.specular = unitRange(number(specular, "specularFactor", 1));
    m.specular_color = nonNegative(color(specular, "specularColorFactor", {1, 1, 1}));
    m.specular_texture = textures.use(specular.Get("specularTexture"), false);
    m.specular_color_texture = textures.use(specular.Get("specularColorTexture"), true);
}

void readClearcoat(const Value& clearcoat, TextureReader& textures, gpu::Material& m)
{
    m.clearcoat = unitRange(number(clearcoat, "clearcoatFactor", 0));
    if (m.clearcoat == 0)
        return;
    m.clearcoat_roughness = unitRange(number(clearcoat, "clearcoatRoughnessFactor", 0));
    m.clearcoat_texture = textures.use(clearcoat.Get("clearcoatTexture"), false);
    m.clearcoat_roughness_texture = textures.use(clearcoat.Get("clearcoatRoughnessTexture"), false);
    m.clearcoat_normal_texture = textures.use(clearcoat.Get("clearcoatNormalTexture"), false);
    m.clearcoat_normal_scale = float(number(clearcoat.Get("clearcoatNormalTexture"), "scale", 1));
}

void readSheen(const Value& sheen, TextureReader& textures, gpu::Material& m)
{
    m.sheen_color = unitRange(color(sheen, "sheenColorFactor", {0, 0, 0}));
    if (isBlack(m.sheen_color))
        return;
    m.sheen_roughness = unitRange(number(sheen, "sheenRoughnessFactor", 0));
    m.sheen_color_texture = textures.use(sheen.Get("sheenColorTexture"), true);
    m.sheen_roughness_texture = textures.use(sheen.Get("sheenRoughnessTexture"), false);
}

void readAnisotropy(const Value& anisotropy, TextureReader& textures, gpu::Material& m)
{
    m.anisotropy = unitRange(number(anisotropy, "anisotropyStrength", 0));
    if (m.anisotropy == 0)
        return;
    m.anisotropy_rotation = float(number(anisotropy, "anisotropyRotation", 0));
    m.anisotropy_texture = textures.use(anisotropy.Get("anisotropyTexture"), false);
}

void readIridescence(const Value& iridescence, TextureReader& textures, gpu::Material& m)
{
    m.iridescence = unitRange(number(iridescence, "iridescenceFactor", 0));
    if (m.iridescence == 0)
        return;
    const auto thickness = [&](const char* key, double fallback)
    { return float(std::max(number(iridescence, key, fallback), 0.0)); };
    m.iridescence_ior = float(std::max(number(iridescence, "iridescenceIor", 1.3), 1.0));
    m.iridescence_thickness_minimum = thickness("iridescenceThicknessMinimum", 100);
    m.iridescence_thickness_maximum = thickness("iridescenceThicknessMaximum", 400);
    m.iridescence_texture = textures.use(iridescence.Get("iridescenceTexture"), false);
    m.iridescence_thickness_texture = textures.use(iridescence.Get("iridescenceThicknessTexture"), false);
}

void readDiffuseTransmission(const Value& diffuse, TextureReader& textures, gpu::Material& m)
{
    m.diffuse_transmission = unitRange(number(diffuse, "diffuseTransmissionFactor", 0));
    if (m.diffuse_transmission == 0)
        return;
    m.diffuse_transmission_color = unitRange(color(diffuse, "diffuseTransmissionColorFactor", {1, 1, 1}));
    m.diffuse_transmission_texture = textures.use(diffuse.Get("diffuseTransmissionTexture"), false);
    m.diffuse_transmission_color_texture = textures.use(diffuse.Get("diffuseTransmissionColorTexture"), true);
}

/// A dielectric whose F0 is the specular colour: with ior 1.5, F0 = 0.04 x specular_color. Exact for factors.
void readSpecularGlossiness(const Value& sg, TextureReader& textures, gpu::Material& m)
{
    m.base_color = nonNegative(color(sg, "diffuseFactor", {1, 1, 1}));
    if (const Value& diffuse = sg.Get("diffuseFactor");
        diffuse.IsArray() && diffuse.ArrayLen() == 4 && diffuse.Get(3).IsNumber())
        m.alpha = unitRange(diffuse.Get(3).GetNumberAsDouble());
    m.metallic = 0;
    m.roughness = 1 - unitRange(number(sg, "glossinessFactor", 1));
    m.specular_color = nonNegative(color(sg, "specularFactor", {1, 1, 1})) * 25.0f;
    m.base_color_texture = textures.use(sg.Get("diffuseTexture"), true);
    m.specular_color_texture = textures.use(sg.Get("specularGlossinessTexture"), true);
    m.metallic_roughness_texture = gpu::kNone;
}

gpu::Material readMaterial(const tinygltf::Material& from, TextureReader& textures)
{
    const auto extension = [&](const char* name) -> const Value*
    {
        const auto it = from.extensions.find(name);
        return it == from.extensions.end() || !it->second.IsObject() ? nullptr : &it->second;
    };
    gpu::Material m = package::defaultMaterial();
    const Value* specular_glossiness = extension("KHR_materials_pbrSpecularGlossiness");
    readCore(from, textures, m);
    readEmission(from, extension("KHR_materials_emissive_strength"), textures, m);
    if (const Value* ior = extension("KHR_materials_ior"))
    {
        const double value = number(*ior, "ior", 1.5);
        m.ior = value == 0 ? 0.0f : float(std::max(value, 1.0)); // 0 is allowed: reflects all
    }
    if (const Value* specular = extension("KHR_materials_specular"))
        readSpecular(*specular, textures, m);
    if (const Value* transmission = extension("KHR_materials_transmission"))
        readTransmission(*transmission, extension("KHR_materials_volume"), textures, m);
    if (const Value* clearcoat = extension("KHR_materials_clearcoat"))
        readClearcoat(*clearcoat, textures, m);
    if (const Value* sheen = extension("KHR_materials_sheen"))
        readSheen(*sheen, textures, m);
    if (const Value* anisotropy = extension("KHR_materials_anisotropy"))
        readAnisotropy(*anisotropy, textures, m);
    if (const Value* iridescence = extension("KHR_materials_iridescence"))
        readIridescence(*iridescence, textures, m);
    if (const Value* dispersion = extension("KHR_materials_dispersion"))
        m.dispersion = float(std::max(number(*dispersion, "dispersion", 0), 0.0));
    if (const Value* diffuse = extension("KHR_materials_diffuse_transmission"))
        readDiffuseTransmission(*diffuse, textures, m);
    if (specular_glossiness != nullptr)
        readSpecularGlossiness(*specular_glossiness, textures, m);
    if (extension("KHR_materials_unlit") != nullptr)
        m.flags |= gpu::kMaterialUnlit;
    return m;
}

/// What replaces a texture that cannot be read.
constexpr std::pair<uint32_t gpu::Material::*, std::string_view> kStandIns[] = {
    {&gpu::Material::base_color_texture, "the base colour factor alone"},
    {&gpu::Material::metallic_roughness_texture, "the metallic and roughness factors alone"},
    {&gpu::Material::normal_texture, "the surface's own normals"},
    {&gpu::Material::emissive_texture, "no emission"},
    {&gpu::Material::transmission_texture, "the transmission factor alone"},
    {&gpu::Material::specular_texture, "the specular factor alone"},
    {&gpu::Material::specular_color_texture, "the specular colour factor alone"},
    {&gpu::Material::clearcoat_texture, "the clear coat factor alone"},
    {&gpu::Material::clearcoat_roughness_texture, "the clear coat's roughness factor alone"},
    {&gpu::Material::clearcoat_normal_texture, "the surface's own normals for the clear coat"},
    {&gpu::Material::sheen_color_texture, "the sheen colour factor alone"},
    {&gpu::Material::sheen_roughness_texture, "the sheen roughness factor alone"},
    {&gpu::Material::anisotropy_texture, "the anisotropy factors alone"},
    {&gpu::Material::iridescence_texture, "the iridescence factor alone"},
    {&gpu::Material::iridescence_thickness_texture, "the largest iridescence thickness"},
    {&gpu::Material::diffuse_transmission_texture, "the diffuse transmission factor alone"},
    {&gpu::Material::diffuse_transmission_color_texture, "the diffuse transmission colour factor alone"},
};
static_assert(std::size(kStandIns) == package::kMaterialTextures.size());

bool hasTransparentTexel(const TextureImage& image)
{
    for (size_t i = 3; i < image.texels.size(); i += 4)
        if (image.texels[i] != 255)
            return true;
    return false;
}
} // namespace

void importMaterials(const GltfFile& file, std::span<const int> used, SceneData& scene,
                     std::vector<ImageRequest>& requests)
{
    TextureReader textures(file, scene, requests);
    bool lost_glossiness = false;
    for (const int index : used)
    {
        const bool is_default = index < 0;
        scene.materials.push_back(is_default ? package::defaultMaterial()
                                             : readMaterial(file.model.materials[size_t(index)], textures));
        if (is_default)
        {
            scene.material_names.push_back("default");
            continue;
        }
        const tinygltf::Material& from = file.model.materials[size_t(index)];
        scene.material_names.push_back(from.name.empty() ? fmt::format("material {}", index) : from.name);
        const auto sg = from.extensions.find("KHR_materials_pbrSpecularGlossiness");
        lost_glossiness |= sg != from.extensions.end() && sg->second.Has("specularGlossinessTexture");
    }
    if (textures.unsupportedTexCoord())
        scene.warnings.push_back({WarningKind::kApproximated, "",
                                  "some textures use a coordinate set above TEXCOORD_1; they are drawn with TEXCOORD_0",
                                  ""});
    if (lost_glossiness)
        scene.warnings.push_back(
            {WarningKind::kLeftOut, "",
             "glossiness textures (KHR_materials_pbrSpecularGlossiness) are left out: only the factor is used", ""});
}

void takeImages(std::vector<DecodedImage> decoded, SceneData& scene)
{
    std::map<int, std::set<std::string_view>> stand_ins; // by image of the file
    for (gpu::Material& m : scene.materials)
        for (const auto& [member, stand_in] : kStandIns)
        {
            if (m.*member == gpu::kNone)
                continue;
            const DecodedImage& image = decoded[scene.texture_uses[m.*member].image];
            if (!image.error)
                continue;
            m.*member = gpu::kNone;
            stand_ins[image.source].insert(stand_in);
            if (member == &gpu::Material::emissive_texture)
                m.emission = {};
        }
    std::vector<uint32_t> image_places(decoded.size(), gpu::kNone); // of those that are left
    for (size_t i = 0; i < decoded.size(); ++i)
    {
        DecodedImage& image = decoded[i];
        if (!image.error)
        {
            image_places[i] = uint32_t(scene.images.size());
            scene.images.push_back(std::move(image.image));
        }
        else if (const auto found = stand_ins.find(image.source); found != stand_ins.end())
        {
            scene.warnings.push_back(
                {WarningKind::kUnreadable, fmt::format("/images/{}", image.source), image.error->message,
                 fmt::format("in its place: {}", fmt::join(found->second, ", ")), image.error->code});
            stand_ins.erase(found); // an image as colour and as data is one
        }
    }
    std::vector<uint32_t> use_places(scene.texture_uses.size(), gpu::kNone);
    std::vector<TextureUse> uses;
    for (size_t i = 0; i < use_places.size(); ++i)
    {
        TextureUse use = scene.texture_uses[i];
        use.image = image_places[use.image];
        if (use.image == gpu::kNone)
            continue;
        use_places[i] = uint32_t(uses.size());
        uses.push_back(use);
    }
    scene.texture_uses = std::move(uses);
    for (gpu::Material& m : scene.materials)
        for (const package::MaterialTexture& texture : package::kMaterialTextures)
            if (m.*texture.index != gpu::kNone)
                m.*texture.index = use_places[m.*texture.index];
}

uint32_t tangentTexture(const gpu::Material& material)
{
    return material.normal_texture != gpu::kNone       ? material.normal_texture
           : material.anisotropy_texture != gpu::kNone ? material.anisotropy_texture
                                                       : material.clearcoat_normal_texture;
}

std::vector<uint32_t> materialTriangleFlags(const SceneData& scene)
{
    constexpr uint32_t kAlpha = gpu::kMaterialAlphaMask | gpu::kMaterialAlphaBlend;
    constexpr float kSmooth = 0.03f; // perceptual roughness below which transmission keeps its direction
    std::vector<uint32_t> flags;
    for (const gpu::Material& m : scene.materials)
    {
        uint32_t f = 0;
        if ((m.flags & kAlpha) != 0)
            if (m.alpha < 1 || ((m.flags & gpu::kMaterialAlphaMask) != 0 && m.alpha_cutoff > 1) ||
                (m.base_color_texture != gpu::kNone &&
                 hasTransparentTexel(scene.images[scene.texture_uses[m.base_color_texture].image])))
                f |= gpu::kTriangleAlpha;
        if ((m.flags & gpu::kMaterialThin) != 0 && m.transmission > 0 && m.roughness < kSmooth &&
            m.metallic_roughness_texture == gpu::kNone)
            f |= gpu::kTriangleThin;
        flags.push_back(f);
    }
    return flags;
}
