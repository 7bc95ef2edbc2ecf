#include "compiler/gltf_repair_items.h"

#include <algorithm>

using nlohmann::json;

namespace
{
void repairVariants(References& references, const JsonPlace& primitive)
{
    json* extensions = primitive.find("extensions");
    if (extensions == nullptr)
        return;
    const auto variants = extensions->find("KHR_materials_variants");
    if (variants == extensions->end() || !variants->is_object() || !variants->contains("mappings"))
        return;
    json& mappings = (*variants)["mappings"];
    for (size_t i = 0; mappings.is_array() && i < mappings.size(); ++i)
        if (mappings[i].is_object())
            references.resolve(
                {mappings[i], fmt::format("{}/mappings/{}", primitive.at("extensions/KHR_materials_variants"), i)},
                "material", "materials", "material", "the primitive's own material counts");
}

bool repairAttributes(References& references, const JsonPlace& attributes)
{
    std::vector<std::string> bad;
    for (auto& [name, value] : attributes.object.items())
    {
        if (!references.names(value, attributes.at(name), "accessors", "accessor",
                              name == "POSITION" ? "the primitive is left out" : "the attribute is left out"))
            bad.push_back(name);
        else
            value = *indexIn(value);
    }
    for (const std::string& name : bad)
        attributes.object.erase(name);
    return std::find(bad.begin(), bad.end(), "POSITION") == bad.end();
}

void repairTargets(References& references, const JsonPlace& primitive)
{
    json* targets = primitive.find("targets");
    if (targets == nullptr)
        return;
    if (!targets->is_array())
    {
        references.warn(WarningKind::kMalformed, primitive.at("targets"), "an array is expected", "it does not morph");
        primitive.object.erase("targets");
        return;
    }
    for (size_t i = 0; i < targets->size(); ++i)
    {
        const std::string pointer = fmt::format("{}/targets/{}", primitive.pointer, i);
        if ((*targets)[i].is_object())
            repairAttributes(references, {(*targets)[i], pointer});
        else
            references.warn(WarningKind::kMalformed, pointer, "an object is expected", "it does not morph");
        if (!(*targets)[i].is_object())
            (*targets)[i] = json::object();
    }
}

bool repairPrimitive(References& references, const JsonPlace& primitive)
{
    constexpr const char* kStandIn = "the primitive is left out";
    json* attributes = primitive.object.is_object() ? primitive.find("attributes") : nullptr;
    if (attributes == nullptr || !attributes->is_object() || attributes->empty())
    {
        references.warn(WarningKind::kMalformed, primitive.pointer, "a primitive has no attributes", kStandIn);
        return false;
    }
    if (const json* mode = primitive.find("mode"); mode != nullptr && (!mode->is_number_unsigned() || *mode > 6))
    {
        references.warn(WarningKind::kMalformed, primitive.at("mode"), "primitive mode does not exist", kStandIn);
        return false;
    }
    references.dropMalformed(primitive);
    const json* extensions = primitive.find("extensions");
    const bool draco = extensions != nullptr && extensions->contains("KHR_draco_mesh_compression");
    references.resolve(primitive, "material", "materials", "material", "the default material counts");
    repairVariants(references, primitive);
    if (!repairAttributes(references, {*attributes, primitive.at("attributes")}))
        return false;
    repairTargets(references, primitive);
    const References::Kind indices = references.resolve(primitive, "indices", "accessors", "accessor", kStandIn);
    if (indices == References::Kind::kBad)
        return false;
    const json* position = attributes->contains("POSITION") ? &(*attributes)["POSITION"] : nullptr;
    const auto empty = [&](const json* accessor)
    { return accessor != nullptr && (*references.list("accessors"))[accessor->get<size_t>()]["count"] == 0u; };
    const auto without_data = [&](const json& accessor)
    { return !accessor.contains("bufferView") && !accessor.contains("sparse"); };
    const json* index = primitive.find("indices");
    if (!empty(position) && !empty(index) &&
        (index == nullptr || draco || !without_data((*references.list("accessors"))[index->get<size_t>()])))
        return true;
    references.warn(WarningKind::kBadGeometry, primitive.pointer, "a primitive is empty", kStandIn);
    return false;
}
} // namespace

void repairMesh(References& references, const JsonPlace& mesh)
{
    json* primitives = mesh.find("primitives");
    if (primitives == nullptr || !primitives->is_array() || primitives->empty())
    {
        references.warn(WarningKind::kMalformed, mesh.pointer, "a mesh has no primitives", "nothing is drawn for it");
        mesh.object["primitives"] = json::array();
        return;
    }
    for (size_t i = 0; i < primitives->size(); ++i)
        if (!repairPrimitive(references, {(*primitives)[i], fmt::format("{}/primitives/{}", mesh.pointer, i)}))
            (*primitives)[i] = {{"attributes", json::object()}};
}
