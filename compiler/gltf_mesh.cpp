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

/// Removes triangles with a corner that does not exist or has no place. @return the error that this is
std::optional<Error> dropBadTriangles(MeshPrimitive& mesh)
{
    const size_t count = mesh.positions.size();
    const auto exists = [count](gpu::uvec3 t) { return std::max({t.x, t.y, t.z}) < count; };
    const auto placed = [&](gpu::uvec3 t)
    { return isFinite(mesh.positions[t.x]) && isFinite(mesh.positions[t.y]) && isFinite(mesh.positions[t.z]); };
    const size_t total = mesh.triangles.size();
    const size_t missing = std::erase_if(mesh.triangles, [&](gpu::uvec3 t) { return !exists(t); });
    const size_t unplaced = std::erase_if(mesh.triangles, [&](gpu::uvec3 t) { return !placed(t); });
    if (const auto good =
            std::find_if(mesh.positions.begin(), mesh.positions.end(), [](gpu::vec3 p) { return isFinite(p); });
        good != mesh.positions.end())
        std::replace_if(
            mesh.positions.begin(), mesh.positions.end(), [](gpu::vec3 p) { return !isFinite(p); }, gpu::vec3(*good));
    if (missing + unplaced == 0)
        return std::nullopt;
    return Error{ExitCode::kInvalid,
                 missing > 0 ? fmt::format("{} of {} triangles name vertices beyond the {} that there are", missing,
                                           total, count)
                             : fmt::format("{} of {} triangles have vertices that are not finite", unplaced, total)};
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
    return readIndices(model, primitive.indices);
}

/// Morphs the mesh and reads its influences; what is damaged of these is left out.
void applyShape(const tinygltf::Model& model, const tinygltf::Primitive& primitive, const PrimitiveShape& shape,
                const AttributeSource& source, const std::string& pointer, Warnings& warnings, GltfPrimitive& result)
{
    if (!shape.morph_weights.empty())
    {
        MeshPrimitive morphed = result.mesh;
        if (const Status status = applyMorphTargets(model, primitive, shape.morph_weights, morphed); status)
            result.mesh = std::move(morphed);
        else
            warnings.push_back(
                warningOf(WarningKind::kBadGeometry, status.error(), pointer, "it is drawn without morphing"));
    }
    if (shape.joint_count == 0)
        return;
    Result<Influences> influences = readInfluences(source, result.mesh.positions.size(), shape.joint_count);
    if (influences)
        result.influences = std::move(*influences);
    else
        warnings.push_back(
            warningOf(WarningKind::kBadGeometry, influences.error(), pointer, "it is drawn where its node is"));
}
} // namespace

Result<std::optional<GltfPrimitive>> readPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                                   const PrimitiveShape& shape, const std::string& pointer,
                                                   Warnings& warnings)
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
    GltfPrimitive result;
    MeshPrimitive& mesh = result.mesh;
    mesh.positions = toVectors<gpu::vec3>(*positions, 0);

    const auto optional = [&](const char* name, uint32_t min_components, uint32_t max_components)
    {
        Result<FloatArray> array = source.read(name, min_components, max_components, count);
        if (array)
            return std::move(*array);
        warnings.push_back({WarningKind::kBadGeometry, pointer + "/attributes/" + name, array.error().message,
                            "the attribute is left out", array.error().code});
        return FloatArray{};
    };
    const FloatArray normals = optional("NORMAL", 3, 3);
    mesh.normals = toVectors<gpu::vec3>(normals, 0);
    if (normals.count > 0)
        mesh.tangents = toVectors<gpu::vec4>(optional("TANGENT", 4, 4), 1);
    mesh.uv0 = toVectors<gpu::vec2>(optional("TEXCOORD_0", 2, 2), 0);
    mesh.uv1 = toVectors<gpu::vec2>(optional("TEXCOORD_1", 2, 2), 0);
    mesh.colors = toVectors<gpu::vec4>(optional("COLOR_0", 3, 4), 1);

    if (*draco && (*draco)->vertex_count != count)
        return Error{ExitCode::kInvalid, "Draco data and POSITION have different numbers of vertices"};
    Result<std::vector<uint32_t>> indices =
        *draco ? Result<std::vector<uint32_t>>((*draco)->indices) : vertexIndices(model, primitive, count);
    if (!indices)
        return indices.error();
    mesh.triangles = assemble(*indices, *draco ? TINYGLTF_MODE_TRIANGLES : mode);
    if (const std::optional<Error> bad = dropBadTriangles(mesh))
        warnings.push_back({WarningKind::kBadGeometry, pointer, bad->message, "they are left out", bad->code});
    applyShape(model, primitive, shape, source, pointer, warnings, result);
    return std::optional<GltfPrimitive>(std::move(result));
}
