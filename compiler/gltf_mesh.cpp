#include "compiler/gltf_mesh.h"

#include "compiler/gltf_attributes.h"
#include "compiler/gltf_morph.h"
#include "compiler/linear.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace
{
template <typename Vector>
std::vector<Vector> toVectors(const FloatArray& array, float last)
{
    constexpr uint32_t kSize = sizeof(Vector) / sizeof(float);
    std::vector<Vector> vectors(array.count);
    for (size_t i = 0; i < array.count; ++i)
    {
        float values[kSize];
        for (uint32_t c = 0; c < kSize; ++c)
            values[c] = c < array.components ? array.values[i * array.components + c] : last;
        std::copy_n(values, kSize, &vectors[i].x);
    }
    return vectors;
}

/// Triangles of a list, strip or fan of vertex indices. A list's incomplete rest is dropped.
std::vector<gpu::uvec3> assemble(const std::vector<uint32_t>& v, int mode)
{
    std::vector<gpu::uvec3> triangles;
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
        for (size_t i = 2; i < v.size(); ++i)
            triangles.push_back(i % 2 == 0 ? gpu::uvec3{v[i - 2], v[i - 1], v[i]}
                                           : gpu::uvec3{v[i - 1], v[i - 2], v[i]});
    else if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
        for (size_t i = 2; i < v.size(); ++i)
            triangles.push_back({v[0], v[i - 1], v[i]});
    else
        for (size_t i = 2; i < v.size(); i += 3)
            triangles.push_back({v[i - 2], v[i - 1], v[i]});
    return triangles;
}

Result<std::vector<uint32_t>> vertexIndices(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                            size_t vertex_count)
{
    if (primitive.indices < 0)
    {
        std::vector<uint32_t> indices(vertex_count);
        std::iota(indices.begin(), indices.end(), 0u);
        return indices;
    }
    Result<std::vector<uint32_t>> indices = readIndices(model, primitive.indices);
    if (!indices)
        return indices.error();
    if (const auto largest = std::max_element(indices->begin(), indices->end());
        largest != indices->end() && *largest >= vertex_count)
        return Error{ExitCode::kInvalid,
                     fmt::format("vertex index {} is out of range: there are {} vertices (/accessors/{})", *largest,
                                 vertex_count, primitive.indices)};
    return indices;
}
} // namespace

Result<std::optional<GltfPrimitive>> readPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                                   const PrimitiveShape& shape)
{
    const int mode = primitive.mode;
    if (mode < TINYGLTF_MODE_POINTS || mode > TINYGLTF_MODE_TRIANGLE_FAN)
        return Error{ExitCode::kInvalid, fmt::format("primitive mode {} does not exist", mode)};
    if (mode < TINYGLTF_MODE_TRIANGLES || !primitive.attributes.contains("POSITION"))
        return std::optional<GltfPrimitive>();
    const auto draco = decodeDraco(model, primitive);
    if (!draco)
        return draco.error();
    const AttributeSource source(model, primitive, *draco ? &**draco : nullptr);

    const Result<FloatArray> positions = source.read("POSITION", 3, 3, AttributeSource::kAnyCount);
    if (!positions)
        return positions.error();
    const size_t count = positions->count;
    if (std::any_of(positions->values.begin(), positions->values.end(), [](float v) { return !std::isfinite(v); }))
        return Error{ExitCode::kInvalid, "POSITION holds a number that is not finite"};
    GltfPrimitive result;
    MeshPrimitive& mesh = result.mesh;
    mesh.positions = toVectors<gpu::vec3>(*positions, 0);

    const Result<FloatArray> normals = source.read("NORMAL", 3, 3, count);
    const Result<FloatArray> tangents = source.read("TANGENT", 4, 4, count);
    const Result<FloatArray> uv0 = source.read("TEXCOORD_0", 2, 2, count);
    const Result<FloatArray> uv1 = source.read("TEXCOORD_1", 2, 2, count);
    const Result<FloatArray> colors = source.read("COLOR_0", 3, 4, count);
    for (const auto* array : {&normals, &tangents, &uv0, &uv1, &colors})
        if (!*array)
            return array->error();
    mesh.normals = toVectors<gpu::vec3>(*normals, 0);
    mesh.tangents = normals->count > 0 ? toVectors<gpu::vec4>(*tangents, 1) : std::vector<gpu::vec4>();
    mesh.uv0 = toVectors<gpu::vec2>(*uv0, 0);
    mesh.uv1 = toVectors<gpu::vec2>(*uv1, 0);
    mesh.colors = toVectors<gpu::vec4>(*colors, 1);

    if (const Status status = applyMorphTargets(model, primitive, shape.morph_weights, mesh); !status)
        return status.error();
    if (shape.joint_count > 0)
    {
        Result<Influences> influences = readInfluences(source, count, shape.joint_count);
        if (!influences)
            return influences.error();
        result.influences = std::move(*influences);
    }

    if (*draco && (*draco)->vertex_count != count)
        return Error{ExitCode::kInvalid, "Draco data and POSITION have different numbers of vertices"};
    Result<std::vector<uint32_t>> indices =
        *draco ? Result<std::vector<uint32_t>>((*draco)->indices) : vertexIndices(model, primitive, count);
    if (!indices)
        return indices.error();
    mesh.triangles = assemble(*indices, *draco ? TINYGLTF_MODE_TRIANGLES : mode);
    return std::optional<GltfPrimitive>(std::move(result));
}
