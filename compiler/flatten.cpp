#include "compiler/flatten.h"

#include "compiler/encode.h"
#include "format/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace
{
constexpr uint32_t kUnset = 0xffffffffu;
constexpr size_t kMaxTriangles = 100'000'000; // spatial splits add to them; leaves address 2^28

struct Double3
{
    double x, y, z;
};

/// Twice the area is below what a shader can still turn into a normal, or below rounding of the longest edge.
bool isDegenerate(gpu::vec3 a, gpu::vec3 b, gpu::vec3 c)
{
    constexpr double kSmallestArea = 1e-18; // m^2; its square is still a normal float
    constexpr double kFlattest = 1e-8;      // height over longest edge
    const auto edge = [](gpu::vec3 p, gpu::vec3 q) {
        return Double3{double(q.x) - p.x, double(q.y) - p.y, double(q.z) - p.z};
    };
    const auto square = [](Double3 v) { return v.x * v.x + v.y * v.y + v.z * v.z; };
    const Double3 u = edge(a, b);
    const Double3 v = edge(a, c);
    const Double3 n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    const double area = std::sqrt(square(n));
    const double longest = std::max({square(u), square(v), square(edge(b, c))});
    return !(area > kSmallestArea) || !(area > kFlattest * longest);
}

/// Finds triangles that were added before; open addressing over positions, so that no order depends on addresses.
class TriangleSet
{
public:
    explicit TriangleSet(size_t expected) : slots_(std::bit_ceil(std::max<size_t>(2 * expected, 16)), kUnset) {}

    /// Adds triangle `index` unless an equal one is there. @return whether it was added
    bool add(const WorldMesh& mesh, uint32_t index)
    {
        const Key key = keyOf(mesh, index);
        uint64_t hash = 0x9e3779b97f4a7c15u;
        for (const uint32_t k : key)
            hash = (hash ^ k) * 0xff51afd7ed558ccdu, hash ^= hash >> 32;
        for (size_t slot = hash & (slots_.size() - 1);; slot = (slot + 1) & (slots_.size() - 1))
        {
            if (slots_[slot] == kUnset)
            {
                slots_[slot] = index;
                return true;
            }
            if (keyOf(mesh, slots_[slot]) == key)
                return false;
        }
    }

private:
    using Corner = std::array<uint32_t, 3>;
    using Key = std::array<uint32_t, 10>; // three positions from the smallest on, material

    static Key keyOf(const WorldMesh& mesh, uint32_t index)
    {
        const gpu::uvec3 t = mesh.triangles[index];
        const auto bits = [&](uint32_t v) // adding 0 turns -0 into 0
        {
            const gpu::vec3 p = mesh.positions[v];
            return Corner{std::bit_cast<uint32_t>(p.x + 0.0f), std::bit_cast<uint32_t>(p.y + 0.0f),
                          std::bit_cast<uint32_t>(p.z + 0.0f)};
        };
        std::array<Corner, 3> corners{bits(t.x), bits(t.y), bits(t.z)};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        Key key;
        for (size_t c = 0; c < 3; ++c)
            std::copy(corners[c].begin(), corners[c].end(), key.begin() + ptrdiff_t(3 * c));
        key[9] = mesh.materials[index];
        return key;
    }

    std::vector<uint32_t> slots_;
};

size_t triangleTotal(const ImportedScene& imported)
{
    size_t total = 0;
    for (const ImportedInstance& instance : imported.instances)
        for (size_t p = 0; p < instance.primitive_count; ++p)
            total += imported.primitives[instance.first_primitive + p].triangles.size();
    return total;
}

class Flattener
{
public:
    Flattener(size_t triangle_total, ImportCounts& counts) : counts_(counts), seen_(triangle_total) {}

    Status add(const MeshPrimitive& primitive, const Transform& to_world, uint32_t object)
    {
        transformPositions(primitive, to_world);
        for (const gpu::vec3 p : world_)
            if (!isFinite(p))
                return Error{ExitCode::kInvalid, "a node's transform moves vertices beyond the range of numbers"};
        slot_.assign(primitive.positions.size(), kUnset);
        const bool mirrored = to_world.determinant() < 0;
        for (const gpu::uvec3 t : primitive.triangles)
            addTriangle(primitive, to_world, object, mirrored ? gpu::uvec3{t.x, t.z, t.y} : t);
        return Success{};
    }

    WorldMesh take() { return std::move(mesh_); }
    uint64_t repairedNormals() const { return repaired_normals_; }
    uint64_t repairedValues() const { return repaired_values_; }

private:
    void transformPositions(const MeshPrimitive& primitive, const Transform& to_world)
    {
        world_.resize(primitive.positions.size());
        for (size_t i = 0; i < world_.size(); ++i)
            world_[i] = to_world.point(primitive.positions[i]);
    }

    void addTriangle(const MeshPrimitive& primitive, const Transform& to_world, uint32_t object, gpu::uvec3 t)
    {
        if (isDegenerate(world_[t.x], world_[t.y], world_[t.z]))
        {
            ++counts_.degenerate_triangles;
            return;
        }
        const gpu::vec3 facing = normalizeOr(cross(world_[t.y] - world_[t.x], world_[t.z] - world_[t.x]), {0, 1, 0});
        const size_t vertices_before = mesh_.positions.size();
        std::array<uint32_t, 3> fresh{kUnset, kUnset, kUnset};
        const auto vertex = [&](uint32_t v, size_t corner)
        {
            if (slot_[v] == kUnset)
            {
                slot_[v] = uint32_t(mesh_.positions.size());
                fresh[corner] = v;
                mesh_.positions.push_back(world_[v]);
                mesh_.attributes.push_back(attributes(primitive, to_world, v, facing));
            }
            return slot_[v];
        };
        mesh_.triangles.push_back({vertex(t.x, 0), vertex(t.y, 1), vertex(t.z, 2)});
        mesh_.materials.push_back(primitive.material);
        mesh_.objects.push_back(object);
        if (seen_.add(mesh_, uint32_t(mesh_.triangles.size() - 1)))
            return;
        ++counts_.duplicate_triangles; // take it back, with the vertices it brought
        mesh_.triangles.pop_back();
        mesh_.materials.pop_back();
        mesh_.objects.pop_back();
        mesh_.positions.resize(vertices_before);
        mesh_.attributes.resize(vertices_before);
        for (const uint32_t v : fresh)
            if (v != kUnset)
                slot_[v] = kUnset;
    }

    float finite(float v)
    {
        if (std::isfinite(v))
            return v;
        ++repaired_values_;
        return 0;
    }

    gpu::VertexAttributes attributes(const MeshPrimitive& from, const Transform& to_world, uint32_t v, gpu::vec3 facing)
    {
        gpu::vec3 normal = normalizeOr(to_world.normal(normalizeOr(from.normals[v], {0, 0, 0})), {0, 0, 0});
        if (dot(normal, normal) == 0)
        {
            normal = facing;
            ++repaired_normals_;
        }
        gpu::VertexAttributes out{};
        out.normal = encodeNormal(normal);
        if (!from.tangents.empty())
        {
            const gpu::vec4 t = from.tangents[v];
            const gpu::vec3 along = to_world.vector({t.x, t.y, t.z});
            const gpu::vec3 tangent = normalizeOr(along - normal * dot(along, normal), anyOrthogonal(normal));
            out.tangent = encodeTangent(tangent, (t.w < 0) != (to_world.determinant() < 0));
        }
        if (!from.uv0.empty())
            out.uv0 = {finite(from.uv0[v].x), finite(from.uv0[v].y)};
        if (!from.uv1.empty())
            out.uv1 = {finite(from.uv1[v].x), finite(from.uv1[v].y)};
        const gpu::vec4 c = from.colors.empty() ? gpu::vec4{1, 1, 1, 1} : from.colors[v];
        const auto channel = [&](float x) { return std::max(finite(x), 0.0f); };
        out.color = encodeColor(channel(c.x), channel(c.y), channel(c.z), std::min(channel(c.w), 1.0f));
        return out;
    }

    ImportCounts& counts_;
    TriangleSet seen_;
    WorldMesh mesh_;
    std::vector<gpu::vec3> world_; // of the primitive being added
    std::vector<uint32_t> slot_;   // its vertices' places in mesh_
    uint64_t repaired_normals_ = 0;
    uint64_t repaired_values_ = 0;
};
} // namespace

Result<WorldMesh> flatten(const ImportedScene& imported, ImportCounts& counts, std::vector<std::string>& warnings)
{
    const size_t total = triangleTotal(imported);
    if (total > kMaxTriangles)
        return Error{
            ExitCode::kUnsupported,
            fmt::format("it has {} triangles with all its instances; at most {} are supported", total, kMaxTriangles)};
    Flattener flattener(total, counts);
    uint32_t object = 0;
    for (const ImportedInstance& instance : imported.instances)
    {
        for (size_t p = 0; p < instance.primitive_count; ++p)
            if (const Status status =
                    flattener.add(imported.primitives[instance.first_primitive + p], instance.to_world, object);
                !status)
                return status.error();
        ++object;
    }
    WorldMesh mesh = flattener.take();
    if (mesh.triangles.empty())
        return Error{ExitCode::kInvalid, "its default scene holds no triangles, so there is nothing to render"};
    mesh.object_count = object;
    if (flattener.repairedNormals() > 0)
        warnings.push_back(
            fmt::format("{} vertex normals have no direction and were replaced by that of their triangle",
                        flattener.repairedNormals()));
    if (flattener.repairedValues() > 0)
        warnings.push_back(fmt::format("{} texture coordinates or vertex colours are not finite and became 0",
                                       flattener.repairedValues()));
    return mesh;
}

Bounds bounds(const WorldMesh& mesh)
{
    check(!mesh.positions.empty(), "no vertices");
    Bounds box{mesh.positions[0], mesh.positions[0]};
    for (const gpu::vec3 p : mesh.positions)
    {
        box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
        box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
    }
    return box;
}
