#include "compiler/gltf_variants.h"

#include <fmt/format.h>

#include <algorithm>

namespace
{
constexpr const char* kExtension = "KHR_materials_variants";

/// A member of the extension that is a list, or null.
const tinygltf::Value& listOf(const tinygltf::ExtensionMap& extensions, const char* key)
{
    static const tinygltf::Value none;
    const auto extension = extensions.find(kExtension);
    if (extension == extensions.end() || !extension->second.IsObject())
        return none;
    const tinygltf::Value& list = extension->second.Get(key);
    return list.IsArray() ? list : none;
}
} // namespace

std::vector<std::string> variantNames(const tinygltf::Model& model)
{
    const tinygltf::Value& variants = listOf(model.extensions, "variants");
    std::vector<std::string> names;
    for (size_t i = 0; i < variants.ArrayLen(); ++i)
    {
        const tinygltf::Value& variant = variants.Get(int(i));
        const bool named = variant.IsObject() && variant.Get("name").IsString();
        names.push_back(named ? variant.Get("name").Get<std::string>() : fmt::format("variant {}", i));
    }
    return names;
}

Result<int> findVariant(const tinygltf::Model& model, const std::string& name)
{
    if (name.empty())
        return -1;
    const std::vector<std::string> names = variantNames(model);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end())
        return int(found - names.begin());
    std::string list;
    for (const std::string& each : names)
        list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", each);
    return Error{ExitCode::kUsage,
                 fmt::format("there is no variant \"{}\"; the file has {}", name, list.empty() ? "none" : list)};
}

int materialOf(const tinygltf::Primitive& primitive, int variant)
{
    const tinygltf::Value& mappings = listOf(primitive.extensions, "mappings");
    for (size_t m = 0; variant >= 0 && m < mappings.ArrayLen(); ++m)
    {
        const tinygltf::Value& mapping = mappings.Get(int(m));
        if (!mapping.IsObject() || !mapping.Get("variants").IsArray() || !mapping.Get("material").IsInt())
            continue;
        const tinygltf::Value& variants = mapping.Get("variants");
        for (size_t v = 0; v < variants.ArrayLen(); ++v)
            if (variants.Get(int(v)).IsInt() && variants.Get(int(v)).GetNumberAsInt() == variant)
                return mapping.Get("material").GetNumberAsInt();
    }
    return primitive.material;
}
