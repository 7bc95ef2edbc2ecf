#include "compiler/gltf_repair_items.h"

using nlohmann::json;

namespace
{
/// Texture references anywhere in a material.
void repairTextures(References& references, const JsonPlace& material, const JsonPlace& place)
{
    std::vector<std::string> bad;
    for (auto& [key, value] : place.object.items())
    {
        if (key == "extras")
            continue;
        const JsonPlace member{value, place.at(key)};
        if (!key.ends_with("Texture"))
        {
            if (value.is_object())
                repairTextures(references, material, member);
            continue;
        }
        const char* stand_in = key == "emissiveTexture"     ? "nothing glows by it"
                               : key.ends_with("alTexture") ? "the surface keeps its normals"
                                                            : "the factor alone counts";
        References::Kind texture = References::Kind::kAbsent;
        if (value.is_object())
            texture = references.resolve(member, "index", "textures", "texture", stand_in);
        if (texture == References::Kind::kAbsent)
            references.warn(WarningKind::kMalformed, member.pointer, "a texture has no index", stand_in);
        if (texture != References::Kind::kGood)
            bad.push_back(key);
        else if (!sizeIn(member, "texCoord", 0))
        {
            references.warn(WarningKind::kMalformed, member.at("texCoord"), "texCoord is no index",
                            "TEXCOORD_0 counts");
            value.erase("texCoord");
        }
    }
    for (const std::string& key : bad)
    {
        place.object.erase(key);
        if (key == "emissiveTexture")
            material.object.erase("emissiveFactor");
    }
}
} // namespace

void repairImage(References& references, const JsonPlace& image)
{
    references.resolve(image, "bufferView", "bufferViews", "buffer view", "it counts as unreadable");
    if (const json* uri = image.find("uri"); uri != nullptr && !uri->is_string())
    {
        references.warn(WarningKind::kMalformed, image.at("uri"), "a string is expected", "it counts as unreadable");
        image.object.erase("uri");
    }
}

void repairTexture(References& references, const JsonPlace& texture)
{
    constexpr const char* kStandIn = "materials that name the texture go without it";
    references.resolve(texture, "sampler", "samplers", "sampler", "the texture repeats");
    references.resolve(texture, "source", "images", "image", kStandIn);
    if (json* extensions = texture.find("extensions"))
        for (auto& [name, value] : extensions->items())
            if (value.is_object())
                references.resolve({value, texture.at("extensions") + "/" + name}, "source", "images", "image",
                                   kStandIn);
}

void repairMaterial(References& references, const JsonPlace& material)
{
    repairMaterialValues(material, references.warnings());
    repairTextures(references, material, material);
}
