#include "compiler/gltf_list.h"

#include "compiler/gltf_document.h"
#include "compiler/gltf_uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

using nlohmann::json;
using nlohmann::ordered_json;

namespace
{
/// The value at `path` below `from`, or null.
const json& at(const json& from, std::initializer_list<const char*> path)
{
    static const json none;
    const json* value = &from;
    for (const char* key : path)
    {
        const auto next = value->is_object() ? value->find(key) : value->end();
        if (next == value->end())
            return none;
        value = &*next;
    }
    return *value;
}

std::string text(const json& item, const char* key)
{
    const json& value = at(item, {key});
    return value.is_string() ? value.get<std::string>() : "";
}

ListedGroup group(const char* name, const json& list)
{
    ListedGroup result{name, {}};
    if (list.is_array())
        for (const json& item : list)
            result.items.push_back({.name = text(item, "name"), .kind = text(item, "type")});
    return result;
}

/// `name` without control characters, which a terminal would obey.
std::string printable(std::string name)
{
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
    return name;
}

/// As the package will name them: by the node that holds a camera, else by the camera.
void nameByNodes(const json& nodes, ListedGroup& cameras)
{
    if (!nodes.is_array())
        return;
    for (const json& node : nodes)
    {
        const json& camera = at(node, {"camera"});
        if (camera.is_number_unsigned() && camera.get<size_t>() < cameras.items.size() && !text(node, "name").empty())
            cameras.items[camera.get<size_t>()].name = text(node, "name");
    }
}
/// The largest key time, which accessors must state.
std::optional<double> durationOf(const json& animation, const json& accessors)
{
    std::optional<double> duration;
    const json& samplers = at(animation, {"samplers"});
    if (!samplers.is_array() || !accessors.is_array())
        return duration;
    for (const json& sampler : samplers)
    {
        const json& input = at(sampler, {"input"});
        if (!input.is_number_unsigned() || input.get<size_t>() >= accessors.size())
            continue;
        const json& most = at(accessors[input.get<size_t>()], {"max"});
        if (most.is_array() && most.size() == 1 && most[0].is_number())
            duration = std::max(duration.value_or(0), most[0].get<double>());
    }
    return duration;
}
} // namespace

Result<std::vector<ListedGroup>> listGltf(const std::filesystem::path& path)
{
    const Result<std::vector<unsigned char>> bytes = readFile(path);
    if (!bytes)
        return bytes.error();
    const Result<GltfDocument> parsed = parseDocument(*bytes);
    if (!parsed)
        return parsed.error();
    const json& document = parsed->json;
    std::vector<ListedGroup> groups{
        group("scenes", at(document, {"scenes"})),
        group("variants", at(document, {"extensions", "KHR_materials_variants", "variants"})),
        group("cameras", at(document, {"cameras"})),
        group("animations", at(document, {"animations"})),
        group("skins", at(document, {"skins"})),
        group("lights", at(document, {"extensions", "KHR_lights_punctual", "lights"})),
        group("materials", at(document, {"materials"})),
    };
    for (ListedItem& scene : groups[0].items)
        scene.kind.clear();
    if (const json& scene = at(document, {"scene"});
        scene.is_number_unsigned() && scene.get<size_t>() < groups[0].items.size())
        groups[0].items[scene.get<size_t>()].kind = "default";
    nameByNodes(at(document, {"nodes"}), groups[2]);
    for (size_t i = 0; i < groups[3].items.size(); ++i)
        groups[3].items[i].duration = durationOf(document["animations"][i], at(document, {"accessors"}));
    return groups;
}

std::string listText(const std::vector<ListedGroup>& groups)
{
    std::string result;
    auto out = std::back_inserter(result);
    for (const ListedGroup& group : groups)
    {
        fmt::format_to(out, "{:<10} {}\n", group.name, group.items.size());
        for (size_t i = 0; i < group.items.size(); ++i)
        {
            const ListedItem& item = group.items[i];
            fmt::format_to(out, "  {:>3}  \"{}\"{}{}{}\n", i, printable(item.name), item.kind.empty() ? "" : " ",
                           printable(item.kind), item.duration ? fmt::format(" {:.4g} s", *item.duration) : "");
        }
    }
    return result;
}

std::string listJson(const std::vector<ListedGroup>& groups, const std::filesystem::path& path)
{
    ordered_json result;
    result["schema"] = "lumicut-compile-list/1";
    result["source"] = path.filename().string();
    for (const ListedGroup& group : groups)
    {
        result[group.name] = ordered_json::array();
        for (const ListedItem& item : group.items)
        {
            ordered_json entry{{"name", item.name}};
            if (item.kind == "default")
                entry["default"] = true;
            else if (!item.kind.empty())
                entry["type"] = item.kind;
            if (item.duration)
                entry["duration"] = *item.duration;
            result[group.name].push_back(entry);
        }
    }
    return result.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}
