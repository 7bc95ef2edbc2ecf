#include "compiler/gltf_draco.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <algorithm>

namespace
{
/// Encoders do not always mark attributes as normalised, so the accessor's word counts.
float normalizedScale(const tinygltf::Accessor& accessor, const draco::PointAttribute& attribute)
{
    if (!accessor.normalized || attribute.normalized())
        return 1;
    switch (accessor.componentType)
    {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return 1.0f / 127;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1.0f / 255;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return 1.0f / 32767;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 1.0f / 65535;
    default:
        return 1;
    }
}

Result<FloatArray> readAttribute(const draco::Mesh& mesh, int unique_id, const tinygltf::Accessor& accessor)
{
    const draco::PointAttribute* attribute = unique_id < 0 ? nullptr : mesh.GetAttributeByUniqueId(uint32_t(unique_id));
    const int components = tinygltf::GetNumComponentsInType(uint32_t(accessor.type));
    if (attribute == nullptr || attribute->num_components() != components || components > 4)
        return Error{ExitCode::kInvalid, fmt::format("Draco attribute {} is missing or of another type", unique_id)};
    FloatArray array{uint32_t(components), mesh.num_points(), {}};
    array.values.resize(array.count * array.components);
    const float scale = normalizedScale(accessor, *attribute);
    for (uint32_t point = 0; point < mesh.num_points(); ++point)
    {
        float* values = &array.values[size_t(point) * array.components];
        const auto index = attribute->mapped_index(draco::PointIndex(point));
        if (index.value() >= attribute->size() || !attribute->ConvertValue<float>(index, int8_t(components), values))
            return Error{ExitCode::kInvalid, fmt::format("Draco attribute {} cannot be read", unique_id)};
        for (int c = 0; c < components; ++c)
            values[c] = std::max(values[c] * scale, scale == 1 ? values[c] : -1.0f);
    }
    return array;
}

Result<std::vector<uint32_t>> readFaces(const draco::Mesh& mesh)
{
    std::vector<uint32_t> indices;
    indices.reserve(size_t(mesh.num_faces()) * 3);
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
        for (const draco::PointIndex& point : mesh.face(face))
        {
            if (point.value() >= mesh.num_points())
                return Error{ExitCode::kInvalid, "a Draco triangle names a vertex that is not there"};
            indices.push_back(point.value());
        }
    return indices;
}
} // namespace

Result<std::optional<DracoMesh>> decodeDraco(const tinygltf::Model& model, const tinygltf::Primitive& primitive)
{
    const auto extension = primitive.extensions.find("KHR_draco_mesh_compression");
    if (extension == primitive.extensions.end())
        return std::optional<DracoMesh>();
    const tinygltf::Value& view_index = extension->second.Get("bufferView");
    const tinygltf::Value& attributes = extension->second.Get("attributes");
    if (!view_index.IsInt() || !attributes.IsObject())
        return Error{ExitCode::kInvalid, "the Draco extension lacks its bufferView or attributes"};
    const Result<ByteView> view = viewBytes(model, view_index.GetNumberAsInt());
    if (!view)
        return view.error();

    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(view->data), view->bytes);
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        return Error{ExitCode::kInvalid, fmt::format("Draco data cannot be decoded: {}", decoded.status().error_msg())};
    const draco::Mesh& mesh = *decoded.value();
    Result<std::vector<uint32_t>> indices = readFaces(mesh);
    if (!indices)
        return indices.error();
    DracoMesh result{mesh.num_points(), std::move(*indices), {}};
    for (const std::string& name : attributes.Keys())
    {
        const auto accessor = primitive.attributes.find(name);
        if (accessor == primitive.attributes.end() || accessor->second < 0 ||
            size_t(accessor->second) >= model.accessors.size() || !attributes.Get(name).IsInt())
            return Error{ExitCode::kInvalid, fmt::format("Draco attribute {} has no accessor", name.substr(0, 40))};
        Result<FloatArray> array =
            readAttribute(mesh, attributes.Get(name).GetNumberAsInt(), model.accessors[size_t(accessor->second)]);
        if (!array)
            return array.error();
        result.attributes.emplace(name, std::move(*array));
    }
    return std::optional<DracoMesh>(std::move(result));
}
