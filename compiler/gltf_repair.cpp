#include "compiler/gltf_repair.h"

#include "compiler/gltf_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

using nlohmann::json;

namespace
{
constexpr const char* kLights = "extensions/KHR_lights_punctual/lights"; // as a list's name and as its place

class Repair
{
public:
    Repair(json& document, Warnings& warnings) : document_(document), warnings_(warnings) {}

    void run()
    {
        repairLists();
        loseEach("bufferViews", [&](const JsonPlace& place) { return repairView(place); });
        loseEach("accessors", [&](const JsonPlace& place) { return repairAccessor(place); });
        each("images", [&](const JsonPlace& place, size_t) { repairImage(place); });
        each("samplers", [&](const JsonPlace& place, size_t) { repairSampler(place, warnings_); });
        each("textures", [&](const JsonPlace& place, size_t) { repairTexture(place); });
        each("materials", [&](const JsonPlace& place, size_t) { repairMaterial(place); });
        each("meshes", [&](const JsonPlace& place, size_t) { repairMesh(place); });
        loseEach("cameras", [&](const JsonPlace& place) { return repairCamera(place, warnings_); });
        loseEach(kLights, [&](const JsonPlace& place) { return repairLight(place, warnings_); });
        parents_.resize(list("nodes") == nullptr ? 0 : list("nodes")->size());
        each("nodes", [&](const JsonPlace& place, size_t i) { repairNode(place, i); });
        each("scenes", [&](const JsonPlace& place, size_t) { repairScene(place); });
        reference({document_, ""}, "scene", "scenes", "scene", "the first scene counts");
    }

private:
    void warn(WarningKind kind, std::string pointer, std::string message, std::string stand_in)
    {
        warnings_.push_back({kind, std::move(pointer), std::move(message), std::move(stand_in)});
    }

    json* list(std::string_view name)
    {
        if (name != kLights)
        {
            const auto it = document_.find(name);
            return it == document_.end() ? nullptr : &*it;
        }
        const json::json_pointer place(std::string("/") + kLights);
        return document_.contains(place) ? &document_[place] : nullptr;
    }

    /// Makes every list an array of objects.
    void repairLists()
    {
        for (const char* key : {"extensions", "extras"})
            if (const auto it = document_.find(key); it != document_.end() && !it->is_object())
                document_.erase(it);
        for (const char* name : {"accessors", "bufferViews", "buffers", "cameras", "images", "materials", "meshes",
                                 "nodes", "samplers", "scenes", "skins", "textures", kLights})
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

    /// Calls repair(place, i) with each item.
    template <typename Function>
    void each(const char* name, const Function& repair)
    {
        json* items = list(name);
        for (size_t i = 0; items != nullptr && i < items->size(); ++i)
        {
            const JsonPlace place{(*items)[i], fmt::format("/{}/{}", name, i)};
            dropMalformed(place);
            repair(place, i);
        }
    }

    /// Items for which `repair` returns false are lost: nothing may refer to them.
    template <typename Function>
    void loseEach(const char* name, const Function& repair)
    {
        std::vector<bool>& lost = lost_[name];
        each(name, [&](const JsonPlace& place, size_t)
        {
            lost.push_back(!repair(place));
            if (lost.back())
                place.object = harmless(name);
        });
    }

    /// Items that the reader accepts and nothing refers to.
    static json harmless(std::string_view name)
    {
        if (name == "bufferViews")
            return {{"buffer", 0}, {"byteLength", 1}};
        if (name == "accessors")
            return {{"componentType", 5126}, {"count", 1}, {"type", "SCALAR"}};
        if (name == "cameras")
            return {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}};
        if (name == kLights)
            return {{"type", "point"}, {"intensity", 0}};
        return json::object();
    }

    void dropMalformed(const JsonPlace& item)
    {
        const json* extensions = item.find("extensions");
        if (extensions == nullptr || extensions->is_object())
            return;
        warn(WarningKind::kMalformed, item.at("extensions"), "an object is expected", "it is taken as empty");
        item.object.erase("extensions");
    }

    enum class Reference
    {
        kAbsent,
        kGood,
        kBad, // and removed
    };

    std::optional<size_t> index(const json& value) const
    {
        if (value.is_number_unsigned())
            return value.get<size_t>();
        if (value.is_number_float() && value.get<double>() >= 0 && value.get<double>() < 4e9 &&
            value.get<double>() == std::floor(value.get<double>()))
            return size_t(value.get<double>());
        return std::nullopt;
    }

    /// Whether `value` is the index of an item of a list; adds a warning if it is not. `what` is the item's noun.
    bool names(const json& value, const std::string& pointer, const char* target, const char* what, const char* stand_in)
    {
        const std::optional<size_t> i = index(value);
        const json* items = list(target);
        if (i && items != nullptr && *i < items->size())
        {
            const auto lost = lost_.find(target);
            return lost == lost_.end() || *i >= lost->second.size() || !lost->second[*i]; // a lost one has its warning
        }
        warn(WarningKind::kDanglingIndex, pointer,
             fmt::format("{} {} does not exist", what, value.dump(-1, ' ', false, json::error_handler_t::replace).substr(0, 40)),
             stand_in);
        return false;
    }

    Reference reference(const JsonPlace& place, const char* key, const char* target, const char* what,
                        const char* stand_in)
    {
        json* value = place.find(key);
        if (value == nullptr)
            return Reference::kAbsent;
        if (!names(*value, place.at(key), target, what, stand_in))
        {
            place.object.erase(key);
            return Reference::kBad;
        }
        *value = *index(*value);
        return Reference::kGood;
    }

    // ---- Data ----

    /// An unsigned number, `fallback` where there is none, nothing where there is something else.
    static std::optional<uint64_t> size(const JsonPlace& place, const char* key, uint64_t fallback)
    {
        const json* value = place.find(key);
        if (value == nullptr)
            return fallback;
        return value->is_number_unsigned() ? std::optional<uint64_t>(value->get<uint64_t>()) : std::nullopt;
    }

    bool repairView(const JsonPlace& view)
    {
        constexpr const char* kStandIn = "what it would hold is left out";
        const Reference buffer = reference(view, "buffer", "buffers", "buffer", kStandIn);
        if (buffer == Reference::kBad)
            return false;
        const auto length = size(view, "byteLength", 0);
        const auto offset = size(view, "byteOffset", 0);
        const auto stride = size(view, "byteStride", 4);
        const char* wrong = buffer == Reference::kAbsent ? "a buffer view names no buffer"
                            : !length || *length == 0    ? "a buffer view has no valid byteLength"
                            : !offset                    ? "a buffer view has no valid byteOffset"
                            : !stride || *stride < 4 || *stride > 252 || *stride % 4 != 0
                                ? "a buffer view's byteStride is no multiple of 4 from 4 to 252"
                                : nullptr;
        if (wrong == nullptr)
        {
            const json& target = (*list("buffers"))[view.object["buffer"].get<size_t>()];
            const auto whole = target.find("byteLength");
            const uint64_t bytes = whole != target.end() && whole->is_number_unsigned() ? whole->get<uint64_t>() : 0;
            if (bytes != 0 && (*offset > bytes || *length > bytes - *offset))
                wrong = "a buffer view reaches past the end of its buffer";
        }
        if (wrong == nullptr)
            return true;
        warn(WarningKind::kMalformed, view.pointer, wrong, kStandIn);
        return false;
    }

    bool repairAccessor(const JsonPlace& accessor)
    {
        constexpr const char* kStandIn = "what it would hold is left out";
        const bool sparse = accessor.find("sparse") != nullptr;
        if (reference(accessor, "bufferView", "bufferViews", "buffer view", kStandIn) == Reference::kBad)
            return false;
        const json* type = accessor.find("type");
        const auto component = size(accessor, "componentType", 0);
        const char* wrong = nullptr;
        if (type == nullptr || (*type != "SCALAR" && *type != "VEC2" && *type != "VEC3" && *type != "VEC4" &&
                                *type != "MAT2" && *type != "MAT3" && *type != "MAT4"))
            wrong = "an accessor's type does not exist";
        else if (!component || *component < 5120 || *component > 5126 || *component == 5124)
            wrong = "an accessor's componentType does not exist";
        else if (accessor.find("count") == nullptr || !size(accessor, "count", 0))
            wrong = "an accessor has no valid count";
        else if (!size(accessor, "byteOffset", 0))
            wrong = "an accessor has no valid byteOffset";
        else if (sparse && !goodSparse({accessor.object["sparse"], accessor.at("sparse")}))
            wrong = "the sparse part of an accessor is damaged";
        if (wrong == nullptr)
            return true;
        warn(WarningKind::kMalformed, accessor.pointer, wrong, kStandIn);
        return false;
    }

    bool goodSparse(const JsonPlace& sparse)
    {
        if (!sparse.object.is_object() || sparse.find("count") == nullptr || !size(sparse, "count", 0))
            return false;
        for (const char* key : {"indices", "values"})
        {
            json* part = sparse.find(key);
            if (part == nullptr || !part->is_object())
                return false;
            const JsonPlace place{*part, sparse.at(key)};
            if (reference(place, "bufferView", "bufferViews", "buffer view", "what it would hold is left out") !=
                    Reference::kGood ||
                !size(place, "byteOffset", 0))
                return false;
            const auto component = size(place, "componentType", 0);
            if (std::string_view(key) == "indices" && (!component || *component < 5120 || *component > 5126))
                return false;
        }
        return true;
    }

    // ---- Materials ----

    void repairImage(const JsonPlace& image) // which is read where a material needs it
    {
        reference(image, "bufferView", "bufferViews", "buffer view", "it counts as unreadable");
        if (const json* uri = image.find("uri"); uri != nullptr && !uri->is_string())
        {
            warn(WarningKind::kMalformed, image.at("uri"), "a string is expected", "it counts as unreadable");
            image.object.erase("uri");
        }
    }

    void repairTexture(const JsonPlace& texture)
    {
        constexpr const char* kStandIn = "materials that name the texture go without it";
        reference(texture, "sampler", "samplers", "sampler", "the texture repeats");
        reference(texture, "source", "images", "image", kStandIn);
        if (json* extensions = texture.find("extensions"))
            for (auto& [name, value] : extensions->items())
                if (value.is_object())
                    reference({value, texture.at("extensions") + "/" + name}, "source", "images", "image", kStandIn);
    }

    void repairMaterial(const JsonPlace& material)
    {
        repairMaterialValues(material, warnings_);
        repairTextures(material, material);
    }

    /// Texture references anywhere in a material.
    void repairTextures(const JsonPlace& material, const JsonPlace& place)
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
                    repairTextures(material, member);
                continue;
            }
            const char* stand_in = key == "emissiveTexture"   ? "nothing glows by it"
                                   : key.ends_with("alTexture") ? "the surface keeps its normals"
                                                              : "the factor alone counts";
            Reference texture = Reference::kAbsent;
            if (value.is_object())
                texture = reference(member, "index", "textures", "texture", stand_in);
            if (texture == Reference::kAbsent)
                warn(WarningKind::kMalformed, member.pointer, "a texture has no index", stand_in);
            if (texture != Reference::kGood)
                bad.push_back(key);
            else if (!size(member, "texCoord", 0))
            {
                warn(WarningKind::kMalformed, member.at("texCoord"), "texCoord is no index", "TEXCOORD_0 counts");
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

    // ---- Meshes ----

    void repairMesh(const JsonPlace& mesh)
    {
        json* primitives = mesh.find("primitives");
        if (primitives == nullptr || !primitives->is_array() || primitives->empty())
        {
            warn(WarningKind::kMalformed, mesh.pointer, "a mesh has no primitives", "nothing is drawn for it");
            mesh.object["primitives"] = json::array();
            return;
        }
        for (size_t i = 0; i < primitives->size(); ++i)
            if (!repairPrimitive({(*primitives)[i], fmt::format("{}/primitives/{}", mesh.pointer, i)}))
                (*primitives)[i] = {{"attributes", json::object()}};
    }

    bool repairPrimitive(const JsonPlace& primitive)
    {
        constexpr const char* kStandIn = "the primitive is left out";
        json* attributes = primitive.object.is_object() ? primitive.find("attributes") : nullptr;
        if (attributes == nullptr || !attributes->is_object() || attributes->empty())
        {
            warn(WarningKind::kMalformed, primitive.pointer, "a primitive has no attributes", kStandIn);
            return false;
        }
        if (const json* mode = primitive.find("mode"); mode != nullptr && (!mode->is_number_unsigned() || *mode > 6))
        {
            warn(WarningKind::kMalformed, primitive.at("mode"), "primitive mode does not exist", kStandIn);
            return false;
        }
        dropMalformed(primitive);
        const json* extensions = primitive.find("extensions");
        const bool draco = extensions != nullptr && extensions->contains("KHR_draco_mesh_compression");
        reference(primitive, "material", "materials", "material", "the default material counts");
        repairVariants(primitive);
        if (!repairAttributes({*attributes, primitive.at("attributes")}))
            return false;
        repairTargets(primitive);
        const Reference indices = reference(primitive, "indices", "accessors", "accessor", kStandIn);
        if (indices == Reference::kBad)
            return false;
        const json* position = attributes->contains("POSITION") ? &(*attributes)["POSITION"] : nullptr;
        const auto empty = [&](const json* accessor)
        { return accessor != nullptr && (*list("accessors"))[accessor->get<size_t>()]["count"] == 0u; };
        const auto without_data = [&](const json& accessor)
        { return !accessor.contains("bufferView") && !accessor.contains("sparse"); };
        const json* index = primitive.find("indices");
        if (!empty(position) && !empty(index) &&
            (index == nullptr || draco || !without_data((*list("accessors"))[index->get<size_t>()])))
            return true;
        warn(WarningKind::kBadGeometry, primitive.pointer, "a primitive is empty", kStandIn);
        return false;
    }

    void repairVariants(const JsonPlace& primitive)
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
                reference({mappings[i], fmt::format("{}/mappings/{}", primitive.at("extensions/KHR_materials_variants"), i)},
                          "material", "materials", "material", "the primitive's own material counts");
    }

    bool repairAttributes(const JsonPlace& attributes)
    {
        std::vector<std::string> bad;
        for (auto& [name, value] : attributes.object.items())
        {
            if (!names(value, attributes.at(name), "accessors", "accessor",
                       name == "POSITION" ? "the primitive is left out" : "the attribute is left out"))
                bad.push_back(name);
            else
                value = *index(value);
        }
        for (const std::string& name : bad)
            attributes.object.erase(name);
        return std::find(bad.begin(), bad.end(), "POSITION") == bad.end();
    }

    void repairTargets(const JsonPlace& primitive)
    {
        json* targets = primitive.find("targets");
        if (targets == nullptr)
            return;
        if (!targets->is_array())
        {
            warn(WarningKind::kMalformed, primitive.at("targets"), "an array is expected", "it does not morph");
            primitive.object.erase("targets");
            return;
        }
        for (size_t i = 0; i < targets->size(); ++i)
        {
            const std::string pointer = fmt::format("{}/targets/{}", primitive.pointer, i);
            if ((*targets)[i].is_object())
                repairAttributes({(*targets)[i], pointer});
            else
                warn(WarningKind::kMalformed, pointer, "an object is expected", "it does not morph");
            if (!(*targets)[i].is_object())
                (*targets)[i] = json::object();
        }
    }

    // ---- Nodes ----

    void repairNode(const JsonPlace& node, size_t number)
    {
        repairTransform(node, warnings_);
        reference(node, "mesh", "meshes", "mesh", "nothing is drawn for it");
        reference(node, "camera", "cameras", "camera", "the camera is left out");
        reference(node, "skin", "skins", "skin", "the mesh is drawn as it is");
        if (json* extensions = node.find("extensions"))
            if (const auto light = extensions->find("KHR_lights_punctual"); light != extensions->end())
                if (!light->is_object() || reference({*light, node.pointer + "/extensions/KHR_lights_punctual"}, "light",
                                                     kLights, "light", "the light is left out") != Reference::kGood)
                    extensions->erase("KHR_lights_punctual");
        repairChildren(node, "children", [&](size_t child, const std::string& pointer)
        {
            if (!parents_[child])
            {
                parents_[child] = number;
                return true;
            }
            warn(WarningKind::kMalformed, pointer, fmt::format("node {} has a parent already", child),
                 "it stays with that one");
            return false;
        });
    }

    /// Keeps those entries of an array of node indices that exist and for which `keep` is true.
    template <typename Keep>
    void repairChildren(const JsonPlace& place, const char* key, const Keep& keep)
    {
        json* children = place.find(key);
        if (children == nullptr)
            return;
        if (!children->is_array())
        {
            warn(WarningKind::kMalformed, place.at(key), "an array is expected", "it is taken as empty");
            place.object.erase(key);
            return;
        }
        json kept = json::array();
        for (size_t i = 0; i < children->size(); ++i)
        {
            const std::string pointer = fmt::format("{}/{}", place.at(key), i);
            if (names((*children)[i], pointer, "nodes", "node", "it is left out") && keep(*index((*children)[i]), pointer))
                kept.push_back(*index((*children)[i]));
        }
        *children = std::move(kept);
    }

    void repairScene(const JsonPlace& scene)
    {
        std::vector<bool> seen(parents_.size());
        repairChildren(scene, "nodes", [&](size_t root, const std::string& pointer)
        {
            if (parents_[root])
                warn(WarningKind::kMalformed, pointer, fmt::format("node {} is no root", root), "its parent places it");
            else if (seen[root])
                warn(WarningKind::kMalformed, pointer, fmt::format("node {} is listed twice", root), "it is placed once");
            const bool keep = !parents_[root] && !seen[root];
            seen[root] = true;
            return keep;
        });
    }

    json& document_;
    Warnings& warnings_;
    std::map<std::string, std::vector<bool>, std::less<>> lost_; // by list: items that nothing may refer to
    std::vector<std::optional<size_t>> parents_;                 // of each node
};
} // namespace

void repairGltf(json& document, Warnings& warnings)
{
    Repair(document, warnings).run();
}
