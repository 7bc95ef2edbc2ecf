#include "compiler/gltf_references.h"

#include <cmath>

using nlohmann::json;

std::optional<size_t> indexIn(const json& value)
{
    if (value.is_number_unsigned())
        return value.get<size_t>();
    if (value.is_number_float() && value.get<double>() >= 0 && value.get<double>() < 4e9 &&
        value.get<double>() == std::floor(value.get<double>()))
        return size_t(value.get<double>());
    return std::nullopt;
}

std::optional<uint64_t> sizeIn(const JsonPlace& place, const char* key, uint64_t fallback)
{
    const json* value = place.find(key);
    if (value == nullptr)
        return fallback;
    return value->is_number_unsigned() ? std::optional<uint64_t>(value->get<uint64_t>()) : std::nullopt;
}

void References::warn(WarningKind kind, std::string pointer, std::string message, std::string stand_in)
{
    warnings_.push_back({kind, std::move(pointer), std::move(message), std::move(stand_in)});
}

json* References::list(std::string_view name)
{
    if (name != kLightList)
    {
        const auto it = document_.find(name);
        return it == document_.end() ? nullptr : &*it;
    }
    const json::json_pointer place(std::string("/") + kLightList);
    return document_.contains(place) ? &document_[place] : nullptr;
}

void References::repairLists()
{
    for (const char* key : {"extensions", "extras"})
        if (const auto it = document_.find(key); it != document_.end() && !it->is_object())
            document_.erase(it);
    for (const char* name : {"accessors", "animations", "bufferViews", "buffers", "cameras", "images", "materials",
                             "meshes", "nodes", "samplers", "scenes", "skins", "textures", kLightList})
    {
        json* items = list(name);
        if (items == nullptr)
            continue;
        if (!items->is_array())
        {
            warn(WarningKind::kMalformed, fmt::format("/{}", name), "an array is expected", "it is taken as empty");
            *items = json::array();
        }
        for (size_t i = 0; i < items->size(); ++i)
        {
            if ((*items)[i].is_object())
                continue;
            warn(WarningKind::kMalformed, fmt::format("/{}/{}", name, i), "an object is expected",
                 "it is taken as empty");
            (*items)[i] = json::object();
        }
    }
}

json References::harmless(std::string_view name)
{
    if (name == "bufferViews")
        return {{"buffer", 0}, {"byteLength", 1}};
    if (name == "accessors")
        return {{"componentType", 5126}, {"count", 1}, {"type", "SCALAR"}};
    if (name == "cameras")
        return {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}};
    if (name == kLightList)
        return {{"type", "point"}, {"intensity", 0}};
    return json::object();
}

void References::dropMalformed(const JsonPlace& item)
{
    const json* extensions = item.find("extensions");
    if (extensions == nullptr || extensions->is_object())
        return;
    warn(WarningKind::kMalformed, item.at("extensions"), "an object is expected", "it is taken as empty");
    item.object.erase("extensions");
}

bool References::names(const json& value, const std::string& pointer, const char* target, const char* what,
                       const char* stand_in)
{
    const std::optional<size_t> i = indexIn(value);
    const json* items = list(target);
    if (i && items != nullptr && *i < items->size())
    {
        const auto lost = lost_.find(target);
        return lost == lost_.end() || *i >= lost->second.size() || !lost->second[*i]; // a lost one has its warning
    }
    warn(WarningKind::kDanglingIndex, pointer,
         fmt::format("{} {} does not exist", what,
                     value.dump(-1, ' ', false, json::error_handler_t::replace).substr(0, 40)),
         stand_in);
    return false;
}

References::Kind References::resolve(const JsonPlace& place, const char* key, const char* target, const char* what,
                                     const char* stand_in)
{
    json* value = place.find(key);
    if (value == nullptr)
        return Kind::kAbsent;
    if (!names(*value, place.at(key), target, what, stand_in))
    {
        place.object.erase(key);
        return Kind::kBad;
    }
    *value = *indexIn(*value);
    return Kind::kGood;
}
