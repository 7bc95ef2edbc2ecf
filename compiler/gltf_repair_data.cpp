#include "compiler/gltf_repair_items.h"

using nlohmann::json;

namespace
{
bool goodSparse(References& references, const JsonPlace& sparse)
{
    if (!sparse.object.is_object() || sparse.find("count") == nullptr || !sizeIn(sparse, "count", 0))
        return false;
    for (const char* key : {"indices", "values"})
    {
        json* part = sparse.find(key);
        if (part == nullptr || !part->is_object())
            return false;
        const JsonPlace place{*part, sparse.at(key)};
        if (references.resolve(place, "bufferView", "bufferViews", "buffer view", "what it would hold is left out") !=
                References::Kind::kGood ||
            !sizeIn(place, "byteOffset", 0))
            return false;
        const auto component = sizeIn(place, "componentType", 0);
        if (std::string_view(key) == "indices" && (!component || *component < 5120 || *component > 5126))
            return false;
    }
    return true;
}
} // namespace

bool repairView(References& references, const JsonPlace& view)
{
    constexpr const char* kStandIn = "what it would hold is left out";
    const References::Kind buffer = references.resolve(view, "buffer", "buffers", "buffer", kStandIn);
    if (buffer == References::Kind::kBad)
        return false;
    const auto length = sizeIn(view, "byteLength", 0);
    const auto offset = sizeIn(view, "byteOffset", 0);
    const auto stride = sizeIn(view, "byteStride", 4);
    const char* wrong = buffer == References::Kind::kAbsent ? "a buffer view names no buffer"
                        : !length || *length == 0           ? "a buffer view has no valid byteLength"
                        : !offset                           ? "a buffer view has no valid byteOffset"
                        : !stride || *stride < 4 || *stride > 252 || *stride % 4 != 0
                            ? "a buffer view's byteStride is no multiple of 4 from 4 to 252"
                            : nullptr;
    if (wrong == nullptr)
    {
        const json& target = (*references.list("buffers"))[view.object["buffer"].get<size_t>()];
        const auto whole = target.find("byteLength");
        const uint64_t bytes = whole != target.end() && whole->is_number_unsigned() ? whole->get<uint64_t>() : 0;
        if (bytes != 0 && (*offset > bytes || *length > bytes - *offset))
            wrong = "a buffer view reaches past the end of its buffer";
    }
    if (wrong == nullptr)
        return true;
    references.warn(WarningKind::kMalformed, view.pointer, wrong, kStandIn);
    return false;
}

bool repairAccessor(References& references, const JsonPlace& accessor)
{
    constexpr const char* kStandIn = "what it would hold is left out";
    const bool sparse = accessor.find("sparse") != nullptr;
    if (references.resolve(accessor, "bufferView", "bufferViews", "buffer view", kStandIn) == References::Kind::kBad)
        return false;
    const json* type = accessor.find("type");
    const auto component = sizeIn(accessor, "componentType", 0);
    const char* wrong = nullptr;
    if (type == nullptr || (*type != "SCALAR" && *type != "VEC2" && *type != "VEC3" && *type != "VEC4" &&
                            *type != "MAT2" && *type != "MAT3" && *type != "MAT4"))
        wrong = "an accessor's type does not exist";
    else if (!component || *component < 5120 || *component > 5126 || *component == 5124)
        wrong = "an accessor's componentType does not exist";
    else if (accessor.find("count") == nullptr || !sizeIn(accessor, "count", 0))
        wrong = "an accessor has no valid count";
    else if (!sizeIn(accessor, "byteOffset", 0))
        wrong = "an accessor has no valid byteOffset";
    else if (sparse && !goodSparse(references, {accessor.object["sparse"], accessor.at("sparse")}))
        wrong = "the sparse part of an accessor is damaged";
    if (wrong == nullptr)
        return true;
    references.warn(WarningKind::kMalformed, accessor.pointer, wrong, kStandIn);
    return false;
}
