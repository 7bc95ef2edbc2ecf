#include "compiler/gltf_repair_items.h"

#include <algorithm>

using nlohmann::json;

namespace
{
/// Keeps those entries of an array of node indices that exist and for which `keep` is true.
template <typename Keep>
void repairChildren(References& references, const JsonPlace& place, const char* key, const Keep& keep)
{
    json* children = place.find(key);
    if (children == nullptr)
        return;
    if (!children->is_array())
    {
        references.warn(WarningKind::kMalformed, place.at(key), "an array is expected", "it is taken as empty");
        place.object.erase(key);
        return;
    }
    json kept = json::array();
    for (size_t i = 0; i < children->size(); ++i)
    {
        const std::string pointer = fmt::format("{}/{}", place.at(key), i);
        if (references.names((*children)[i], pointer, "nodes", "node", "it is left out") &&
            keep(*indexIn((*children)[i]), pointer))
            kept.push_back(*indexIn((*children)[i]));
    }
    *children = std::move(kept);
}
} // namespace

void repairNode(References& references, const JsonPlace& node, size_t number, NodeParents& parents)
{
    repairTransform(node, references.warnings());
    references.resolve(node, "mesh", "meshes", "mesh", "nothing is drawn for it");
    references.resolve(node, "camera", "cameras", "camera", "the camera is left out");
    references.resolve(node, "skin", "skins", "skin", "the mesh is drawn as it is");
    if (json* extensions = node.find("extensions"))
        if (const auto light = extensions->find("KHR_lights_punctual"); light != extensions->end())
            if (!light->is_object() ||
                references.resolve({*light, node.pointer + "/extensions/KHR_lights_punctual"}, "light", kLightList,
                                   "light", "the light is left out") != References::Kind::kGood)
                extensions->erase("KHR_lights_punctual");
    repairChildren(references, node, "children",
                   [&](size_t child, const std::string& pointer)
                   {
                       if (!parents[child])
                       {
                           parents[child] = number;
                           return true;
                       }
                       references.warn(WarningKind::kMalformed, pointer,
                                       fmt::format("node {} has a parent already", child), "it stays with that one");
                       return false;
                   });
}

void breakCycles(References& references, NodeParents& parents)
{
    std::vector<size_t> walk(parents.size()); // the node from which each was reached first, 1 + its number
    for (size_t from = 0; from < parents.size(); ++from)
    {
        size_t at = from;
        for (; walk[at] == 0 && parents[at]; at = *parents[at])
            walk[at] = from + 1;
        if (!parents[at] || walk[at] != from + 1)
            continue;
        const size_t parent = *parents[at];
        json& children = (*references.list("nodes"))[parent]["children"];
        references.warn(WarningKind::kMalformed, fmt::format("/nodes/{}/children", parent),
                        fmt::format("node {} is its own ancestor", at), "it has no parent");
        children.erase(std::find(children.begin(), children.end(), json(at)));
        parents[at].reset();
    }
}

void repairScene(References& references, const JsonPlace& scene, const NodeParents& parents)
{
    std::vector<bool> seen(parents.size());
    repairChildren(references, scene, "nodes",
                   [&](size_t root, const std::string& pointer)
                   {
                       if (parents[root])
                           references.warn(WarningKind::kMalformed, pointer, fmt::format("node {} is no root", root),
                                           "its parent places it");
                       else if (seen[root])
                           references.warn(WarningKind::kMalformed, pointer,
                                           fmt::format("node {} is listed twice", root), "it is placed once");
                       const bool keep = !parents[root] && !seen[root];
                       seen[root] = true;
                       return keep;
                   });
}
