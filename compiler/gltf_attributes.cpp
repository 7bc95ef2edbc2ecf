#include "compiler/gltf_attributes.h"

#include <fmt/format.h>

AttributeSource::AttributeSource(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                 const DracoMesh* draco)
    : model_(model), primitive_(primitive), draco_(draco)
{
}

bool AttributeSource::has(const std::string& name) const
{
    return primitive_.attributes.contains(name);
}

Result<FloatArray> AttributeSource::read(const std::string& name, uint32_t min_components, uint32_t max_components,
                                         size_t vertex_count) const
{
    const auto attribute = primitive_.attributes.find(name);
    if (attribute == primitive_.attributes.end())
        return FloatArray{};
    Result<FloatArray> array = FloatArray{};
    if (draco_ != nullptr && draco_->attributes.contains(name))
        array = draco_->attributes.at(name);
    else
        array = readFloats(model_, attribute->second, min_components, max_components);
    if (!array)
        return Error{array.error().code, fmt::format("{}: {}", name, array.error().message)};
    if (array->components < min_components || array->components > max_components)
        return Error{ExitCode::kInvalid, fmt::format("{} has {} components", name, array->components)};
    if (vertex_count != kAnyCount && array->count != vertex_count)
        return Error{ExitCode::kInvalid,
                     fmt::format("{} has {} elements for {} vertices", name, array->count, vertex_count)};
    return array;
}
