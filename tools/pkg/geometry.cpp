#include "tools/pkg/geometry.h"

#include "compiler/encode.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>

namespace
{
using Json = nlohmann::ordered_json;

/// The one buffer of the file and what describes it.
struct Buffer
{
    std::vector<uint8_t> bytes;
    Json views = Json::array();
    Json accessors = Json::array();

    template <typename T>
    size_t add(const std::vector<T>& data, size_t count, const char* type, int component_type, const Json& extra)
    {
        views.push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size() * sizeof(T)}});
        const auto* from = reinterpret_cast<const uint8_t*>(data.data());
        bytes.insert(bytes.end(), from, from + data.size() * sizeof(T));
        Json accessor{
            {"bufferView", views.size() - 1}, {"componentType", component_type}, {"count", count}, {"type", type}};
        accessor.update(extra);
        accessors.push_back(accessor);
        return accessors.size() - 1;
    }
};
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;

/// Positions lie with the hierarchy's triangles: each vertex takes that of a triangle that uses it.
std::vector<gpu::vec3> vertexPositions(const package::Package& package)
{
    std::vector<gpu::vec3> positions(package.vertexAttributes().size());
    for (const gpu::BvhTriangle& t : package.bvhTriangles())
    {
        const gpu::uvec3& v = package.triangles()[t.triangle].vertices;
        positions[v.x] = t.v0;
        positions[v.y] = t.v1;
        positions[v.z] = t.v2;
    }
    return positions;
}

Json addVertices(const package::Package& package, Buffer& buffer)
{
    const std::vector<gpu::vec3> positions = vertexPositions(package);
    std::vector<gpu::vec3> normals;
    std::vector<gpu::vec2> uvs;
    for (const gpu::VertexAttributes& vertex : package.vertexAttributes())
    {
        normals.push_back(decodeNormal(vertex.normal));
        uvs.push_back(vertex.uv0);
    }
    gpu::vec3 low = positions[0], high = positions[0];
    for (const gpu::vec3& p : positions)
    {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Json bounds{{"min", {low.x, low.y, low.z}}, {"max", {high.x, high.y, high.z}}};
    return {{"POSITION", buffer.add(positions, positions.size(), "VEC3", kFloat, bounds)},
            {"NORMAL", buffer.add(normals, normals.size(), "VEC3", kFloat, Json::object())},
            {"TEXCOORD_0", buffer.add(uvs, uvs.size(), "VEC2", kFloat, Json::object())}};
}

/// [material_count][3 * triangles of that material]
std::vector<std::vector<uint32_t>> indicesByMaterial(const package::Package& package)
{
    std::vector<uint32_t> material_of(package.triangles().size());
    for (const gpu::BvhTriangle& t : package.bvhTriangles())
        material_of[t.triangle] = t.material;
    std::vector<std::vector<uint32_t>> indices(package.materials().size());
    for (size_t i = 0; i < material_of.size(); ++i)
    {
        const gpu::uvec3& v = package.triangles()[i].vertices;
        indices[material_of[i]].insert(indices[material_of[i]].end(), {v.x, v.y, v.z});
    }
    return indices;
}

std::vector<uint8_t> glb(const Json& document, std::vector<uint8_t> binary)
{
    std::string text = document.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4);
    std::vector<uint8_t> file;
    const auto u32 = [&](size_t value)
    {
        for (int shift = 0; shift < 32; shift += 8)
            file.push_back(uint8_t(value >> shift));
    };
    u32(0x46546C67), u32(2), u32(12 + 8 + text.size() + 8 + binary.size());
    u32(text.size()), u32(0x4E4F534A);
    file.insert(file.end(), text.begin(), text.end());
    u32(binary.size()), u32(0x004E4942);
    file.insert(file.end(), binary.begin(), binary.end());
    return file;
}
} // namespace

std::vector<uint8_t> geometryGlb(const package::Package& package)
{
    const lumicut::fb::Meta& meta = package.meta();
    Buffer buffer;
    const Json attributes = addVertices(package, buffer);
    Json primitives = Json::array();
    Json materials = Json::array();
    const auto indices = indicesByMaterial(package);
    for (size_t m = 0; m < indices.size(); ++m)
    {
        const gpu::Material& material = package.materials()[m];
        const auto* name = meta.material_names()->Get(uint32_t(m));
        materials.push_back({{"name", name ? name->str() : ""},
                             {"doubleSided", (material.flags & gpu::kMaterialDoubleSided) != 0},
                             {"pbrMetallicRoughness",
                              {{"baseColorFactor",
                                {material.base_color.x, material.base_color.y, material.base_color.z, material.alpha}},
                               {"metallicFactor", material.metallic},
                               {"roughnessFactor", material.roughness}}}});
        if (!indices[m].empty())
            primitives.push_back(
                {{"attributes", attributes},
                 {"indices", buffer.add(indices[m], indices[m].size(), "SCALAR", kUnsignedInt, Json::object())},
                 {"material", m}});
    }
    Json node{{"name", "package"}, {"mesh", 0}};
    if (const auto* origin = meta.origin())
        node["translation"] = {origin->x(), origin->y(), origin->z()};
    if (meta.unit() != 1)
        node["scale"] = {meta.unit(), meta.unit(), meta.unit()};
    const Json document{{"asset", {{"version", "2.0"}, {"generator", "lumicut-pkg extract"}}},
                        {"scene", 0},
                        {"scenes", {{{"nodes", {0}}}}},
                        {"nodes", {node}},
                        {"meshes", {{{"primitives", primitives}}}},
                        {"materials", materials},
                        {"buffers", {{{"byteLength", buffer.bytes.size()}}}},
                        {"bufferViews", buffer.views},
                        {"accessors", buffer.accessors}};
    return glb(document, buffer.bytes);
}
