#include "compiler/gltf_extensions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

namespace
{
constexpr std::array kHonoured = std::to_array<std::string_view>({
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
});
// Leaving these out keeps the picture as its author meant it to be without a choice of the user.
constexpr std::array<std::string_view, 2> kHarmless{"KHR_xmp", "KHR_xmp_json_ld"};

template <size_t n>
bool contains(const std::array<std::string_view, n>& list, std::string_view name)
{
    return std::find(list.begin(), list.end(), name) != list.end();
}

Result<std::set<std::string>> names(const nlohmann::json& document, const char* key)
{
    std::set<std::string> result;
    const auto list = document.find(key);
    if (list == document.end())
        return result;
    if (!list->is_array())
        return Error{ExitCode::kInvalid, fmt::format("an array of strings is expected (/{})", key)};
    for (const auto& name : *list)
    {
        if (!name.is_string())
            return Error{ExitCode::kInvalid, fmt::format("an array of strings is expected (/{})", key)};
        result.insert(name.get<std::string>());
    }
    return result;
}

std::string refusal(const std::string& name)
{
    return fmt::format(
        "it requires the extension {}, which is not supported; export the scene without it (/extensionsRequired)",
        name.substr(0, 100));
}
} // namespace

Status checkExtensions(const nlohmann::json& document, Warnings& warnings)
{
    const Result<std::set<std::string>> required = names(document, "extensionsRequired");
    const Result<std::set<std::string>> used = names(document, "extensionsUsed");
    if (!required || !used)
        return required ? used.error() : required.error();
    for (const std::string& name : *required)
        if (!contains(kHonoured, name) && !contains(kHarmless, name))
            return Error{ExitCode::kUnsupported, refusal(name)};
    std::vector<std::string> dropped;
    for (const std::string& name : *used)
        if (!contains(kHonoured, name) && !contains(kHarmless, name))
            dropped.push_back(name);
    if (!dropped.empty())
        warnings.push_back({WarningKind::kLeftOut, "/extensionsUsed",
                            fmt::format("extensions that are not supported are left out: {}", fmt::join(dropped, ", ")),
                            ""});
    return Success{};
}
