#include "compiler/flatten.h"

#include "compiler/encode.h"
#include "compiler/gltf_material.h"
#include "compiler/moving_vertex.h"
#include "compiler/tangents.h"
#include "format/check.h"
#include "format/large_memory.h"

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

/// Twice the area is below what a shader can still turn into a normal, or below rounding of the longest edge.
bool isDegenerate(gpu::vec3 a, gpu::vec3 b, gpu::vec3 c)
{
    // Its square is still a normal float. Sizes of scenes are 2^-10 units of length and more (world_frame.h), so that
    // edges of a millionth of that pass.
    constexpr double kSmallestArea = 1e-18;
    constexpr double kFlattest = 1e-8; // height over longest edge
    const Vec3d u = toDouble(b) - toDouble(a);
    const Vec3d v = toDouble(c) - toDouble(a);
    const Vec3d w = toDouble(c) - toDouble(b);
    const double area = length(cross(u, v));
    const double longest = std::max({dot(u, u), dot(v, v), dot(w, w)});
    return !(area > kSmallestArea) || !(area > kFlattest * longest);
}

/// Finds triangles that were added before; open addressing over positions, so that no order depends on addresses.
class TriangleSet
{
public:
    explicit TriangleSet(size_t expected)
    {
        const size_t size = std::bit_ceil(std::max<size_t>(expected + expected / 2, 16));
        reserveLarge(slots_, size);
        slots_.resize(size, kEmpty);
    }

    /// Of three positions in their order, wherever it starts, and the material.
    static uint64_t hashOf(gpu::vec3 a, gpu::vec3 b, gpu::vec3 c, uint32_t material)
    {
        uint64_t hash = 0x9e3779b97f4a7c15u;
        for (const uint32_t k : keyOf(a, b, c, material))
            hash = (hash ^ k) * 0xff51afd7ed558ccdu, hash ^= hash >> 32;
        return hash;
    }

    /// Prefetches the entry of a hash that add() will need soon: the table is larger than caches.
    void prefetch(uint64_t hash) const { __builtin_prefetch(&slots_[hash & (slots_.size() - 1)]); }

    /// Adds triangle `index` unless an equal one is there. @return whether it was added
    bool add(const WorldMesh& mesh, uint32_t index, uint64_t hash)
    {
        const uint64_t entry = (hash & kTagMask) | index;
        for (size_t slot = hash & (slots_.size() - 1);; slot = (slot + 1) & (slots_.size() - 1))
        {
            if (slots_[slot] == kEmpty)
            {
                slots_[slot] = entry;
                return true;
            }
            if ((slots_[slot] & kTagMask) == (hash & kTagMask) &&
                keyOf(mesh, uint32_t(slots_[slot])) == keyOf(mesh, index))
                return false;
        }
    }

private:
    using Corner = std::array<uint32_t, 3>;
    using Key = std::array<uint32_t, 10>; // three positions from the smallest on, material

    static constexpr uint64_t kTagMask = 0xffffffff00000000u; // of the hash, before the triangle's index
    static constexpr uint64_t kEmpty = kUnset;                // no triangle has this index

    static Key keyOf(const WorldMesh& mesh, uint32_t index)
    {
        const gpu::uvec3 t = mesh.triangles[index];
        return keyOf(mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z], mesh.materials[index]);
    }

    static Key keyOf(gpu::vec3 a, gpu::vec3 b, gpu::vec3 c, uint32_t material)
    {
        const auto bits = [](gpu::vec3 p) // adding 0 turns -0 into 0
        {
            return Corner{std::bit_cast<uint32_t>(p.x + 0.0f), std::bit_cast<uint32_t>(p.y + 0.0f),
                          std::bit_cast<uint32_t>(p.z + 0.0f)};
        };
        std::array<Corner, 3> corners{bits(a), bits(b), bits(c)};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        Key key;
        for (size_t i = 0; i < 3; ++i)
            std::copy(corners[i].begin(), corners[i].end(), key.begin() + ptrdiff_t(3 * i));
        key[9] = material;
        return key;
    }

    std::vector<uint64_t> slots_;
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
    Flattener(const SceneData& scene, size_t triangle_total, ImportCounts& counts)
        : scene_(scene), counts_(counts), seen_(triangle_total)
    {
        reserveLarge(mesh_.triangles, triangle_total);
        reserveLarge(mesh_.materials, triangle_total);
        reserveLarge(mesh_.objects, triangle_total);
        reserveLarge(mesh_.positions, triangle_total); // of closed meshes half as many; untouched memory costs nothing
        reserveLarge(mesh_.attributes, triangle_total);
    }

    /// Adds a primitive that moves, under `place`; what moves its vertices goes to `motion`.
    /// @return false where nothing was added: vertices are beyond the range of numbers
    bool addMoving(const MeshPrimitive& primitive, const Transform& to_world, uint32_t object, const MovingPlace& place,
                   MotionData& motion)
    {
        transformVertices(primitive, to_world);
        if (!std::all_of(world_.begin(), world_.end(), [](gpu::vec3 p) { return isFinite(p); }))
            return false;
        if (place.hidden)
            std::fill(world_.begin(), world_.end(), hiding_place_);
        for (std::vector<uint32_t>& slots : slots_)
            slots.assign(primitive.positions.size(), kUnset);
        const bool mirrored = to_world.determinant() < 0;
        for (const gpu::uvec3& t : primitive.triangles)
            addMovingTriangle(primitive, mirrored, object, mirrored ? gpu::uvec3{t.x, t.z, t.y} : t, place, motion);
        return true;
    }

    /// @return false where nothing was added: vertices are beyond the range of numbers
    bool add(const MeshPrimitive& primitive, const Transform& to_world, uint32_t object)
    {
        transformVertices(primitive, to_world);
        if (!std::all_of(world_.begin(), world_.end(), [](gpu::vec3 p) { return isFinite(p); }))
            return false;
        for (std::vector<uint32_t>& slots : slots_)
            slots.assign(primitive.positions.size(), kUnset);
        const bool mirrored = to_world.determinant() < 0;
        const auto wound = [&](size_t i)
        {
            const gpu::uvec3 t = primitive.triangles[i];
            return mirrored ? gpu::uvec3{t.x, t.z, t.y} : t;
        };
        const auto hash = [&](gpu::uvec3 t)
        { return TriangleSet::hashOf(world_[t.x], world_[t.y], world_[t.z], primitive.material); };
        constexpr size_t kAhead = 8;
        for (size_t i = 0; i < primitive.triangles.size(); ++i)
        {
            if (i + kAhead < primitive.triangles.size())
                seen_.prefetch(hash(wound(i + kAhead)));
            addTriangle(primitive, mirrored, object, wound(i), hash(wound(i)));
        }
        return true;
    }

    size_t triangleCount() const { return mesh_.triangles.size(); }
    /// A vertex that stands still, so that what is hidden does not widen the scene.
    void chooseHidingPlace()
    {
        if (!mesh_.positions.empty())
            hiding_place_ = mesh_.positions.front();
    }
    /// From the next triangle on there is another object that moves.
    void beginMoving() { mesh_.moving.push_back(uint32_t(mesh_.triangles.size())); }
    void dropEmpty()
    {
        if (mesh_.moving.back() == mesh_.triangles.size())
            mesh_.moving.pop_back();
    }

    WorldMesh take() { return std::move(mesh_); }
    uint64_t flippedTriangles() const { return flipped_triangles_; }
    uint64_t repairedNormals() const { return repaired_normals_; }
    uint64_t repairedValues() const { return repaired_values_; }

private:
    void transformVertices(const MeshPrimitive& primitive, const Transform& to_world)
    {
        world_.resize(primitive.positions.size());
        normals_.resize(primitive.positions.size());
        for (size_t i = 0; i < world_.size(); ++i)
        {
            world_[i] = toFloat(to_world.point(toDouble(primitive.positions[i])));
            normals_[i] = unitOrZero(to_world.normal(unitOrZero(toDouble(primitive.normals[i]))));
        }
        tangents_.clear();
        for (const gpu::vec4& t : primitive.tangents)
            tangents_.push_back(unitOrZero(to_world.vector({t.x, t.y, t.z})));
    }

    /// Whether the normals of all three corners are behind the triangle. Nearly tangential ones are left to shading, which
    /// bends normals to the viewer's side: where faces meet smoothly at right angles, their sign depends on rounding.
    bool opposesWinding(gpu::uvec3 t, const Vec3d& facing) const
    {
        constexpr double kBehind = -0.05; // sine of 3 degrees
        bool any = false;
        for (const uint32_t v : {t.x, t.y, t.z})
        {
            if (normals_[v] == Vec3d{})
                continue;
            if (dot(normals_[v], facing) > kBehind)
                return false;
            any = true;
        }
        return any;
    }

    void addTriangle(const MeshPrimitive& primitive, bool mirrored, uint32_t object, gpu::uvec3 t, uint64_t hash)
    {
        if (isDegenerate(world_[t.x], world_[t.y], world_[t.z]))
        {
            ++counts_.degenerate_triangles;
            return;
        }
        const Vec3d facing = facingOf(t);
        const bool flipped = opposesWinding(t, facing);
        std::vector<uint32_t>& slots = slots_[flipped];
        const size_t vertices_before = mesh_.positions.size();
        std::array<uint32_t, 3> fresh{kUnset, kUnset, kUnset};
        const auto vertex = [&](uint32_t v, size_t place)
        {
            if (slots[v] == kUnset)
            {
                slots[v] = uint32_t(mesh_.positions.size());
                fresh[place] = v;
                mesh_.positions.push_back(world_[v]);
                mesh_.attributes.push_back(attributes(primitive, mirrored, v, t, facing, flipped));
            }
            return slots[v];
        };
        mesh_.triangles.push_back({vertex(t.x, 0), vertex(t.y, 1), vertex(t.z, 2)});
        mesh_.materials.push_back(primitive.material);
        mesh_.objects.push_back(object);
        if (seen_.add(mesh_, uint32_t(mesh_.triangles.size() - 1), hash))
        {
            flipped_triangles_ += flipped;
            return;
        }
        ++counts_.duplicate_triangles; // remove it with the vertices added for it
        mesh_.triangles.pop_back();
        mesh_.materials.pop_back();
        mesh_.objects.pop_back();
        mesh_.positions.resize(vertices_before);
        mesh_.attributes.resize(vertices_before);
        for (const uint32_t v : fresh)
            if (v != kUnset)
                slots[v] = kUnset;
    }

    Vec3d facingOf(gpu::uvec3 t) const
    {
        const Vec3d corner = toDouble(world_[t.x]);
        return unitOrZero(cross(toDouble(world_[t.y]) - corner, toDouble(world_[t.z]) - corner));
    }

    void addMovingTriangle(const MeshPrimitive& primitive, bool mirrored, uint32_t object, gpu::uvec3 t,
                           const MovingPlace& place, MotionData& motion)
    {
        if (t.x == t.y || t.y == t.z || t.z == t.x) // never has an area
        {
            ++counts_.degenerate_triangles;
            return;
        }
        const Vec3d facing = facingOf(t);
        const bool flipped = opposesWinding(t, facing);
        const auto vertex = [&](uint32_t v)
        {
            uint32_t& slot = slots_[flipped][v];
            if (slot == kUnset)
            {
                slot = uint32_t(mesh_.positions.size());
                mesh_.positions.push_back(world_[v]);
                mesh_.attributes.push_back(attributes(primitive, mirrored, v, t, facing, flipped));
                const bool turned = primitive.moving->mirrored.empty() ? mirrored : primitive.moving->mirrored[v];
                const bool negative =
                    !primitive.tangents.empty() && negativeBitangent(primitive, mirrored, v, t, flipped) != turned;
                appendMovingVertex({.moving = *primitive.moving,
                                    .vertex = v,
                                    .triangle = t,
                                    .flipped = flipped,
                                    .mirrored = turned,
                                    .negative_bitangent = negative},
                                   place, motion);
            }
            return slot;
        };
        mesh_.triangles.push_back({vertex(t.x), vertex(t.y), vertex(t.z)});
        mesh_.materials.push_back(primitive.material);
        mesh_.objects.push_back(object);
        flipped_triangles_ += flipped;
    }

    float finite(float v)
    {
        if (std::isfinite(v))
            return v;
        ++repaired_values_;
        return 0;
    }

    /// Normals against the winding come with signs made before either was turned, or with signs made from the winding:
    /// only the normal map's coordinates tell.
    bool negativeBitangent(const MeshPrimitive& from, bool mirrored, uint32_t v, gpu::uvec3 t, bool flipped) const
    {
        const bool given = (from.tangents[v].w < 0) != mirrored;
        const uint32_t map = tangentTexture(scene_.materials[from.material]);
        if (!flipped || map == gpu::kNone)
            return given != flipped;
        const float sign = handedness(from, t, scene_.texture_uses[map]);
        return sign == 0 ? !given : sign < 0;
    }

    /// Of vertex `v` in triangle `t` (wound for world space), whose normals are to be flipped or not.
    gpu::VertexAttributes attributes(const MeshPrimitive& from, bool mirrored, uint32_t v, gpu::uvec3 t,
                                     const Vec3d& facing, bool flipped)
    {
        Vec3d normal = flipped ? normals_[v] * -1 : normals_[v];
        if (normal == Vec3d{})
        {
            normal = facing == Vec3d{} ? Vec3d{0, 1, 0} : facing; // of no area: one that moves
            ++repaired_normals_;
        }
        gpu::VertexAttributes out{};
        out.normal = encodeNormal(toFloat(normal));
        if (!from.tangents.empty())
        {
            const gpu::vec3 tangent =
                directionOr(tangents_[v] - normal * dot(tangents_[v], normal), anyOrthogonal(toFloat(normal)));
            out.tangent = encodeTangent(tangent, negativeBitangent(from, mirrored, v, t, flipped));
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

    const SceneData& scene_;
    ImportCounts& counts_;
    TriangleSet seen_;
    WorldMesh mesh_;
    // Of the primitive being added:
    std::vector<gpu::vec3> world_;               // positions
    gpu::vec3 hiding_place_{0, 0, 0};            // where objects are that nobody sees at rest
    std::vector<Vec3d> normals_;                 // unit, 0 where the file's has no direction
    std::vector<Vec3d> tangents_;                // unit or 0
    std::array<std::vector<uint32_t>, 2> slots_; // places of its vertices in mesh_: as they are, with normals flipped
    uint64_t flipped_triangles_ = 0;
    uint64_t repaired_normals_ = 0;
    uint64_t repaired_values_ = 0;
};
void addObject(const MovingPlace& place, size_t first_triangle, size_t triangles_end, MotionData& motion)
{
    if (first_triangle == triangles_end)
        return;
    auto object = std::make_unique<lumicut::fb::MovingObjectT>();
    object->node = place.node;
    object->first_triangle = uint32_t(first_triangle);
    object->triangle_count = uint32_t(triangles_end - first_triangle);
    motion.tables.objects.push_back(std::move(object));
}
} // namespace

Result<WorldMesh> flatten(ImportedScene& imported, ImportCounts& counts, Warnings& warnings)
{
    const size_t total = triangleTotal(imported);
    if (total > kMaxTriangles)
        return Error{
            ExitCode::kUnsupported,
            fmt::format("it has {} triangles with all its instances; at most {} are supported", total, kMaxTriangles)};
    Flattener flattener(imported.scene, total, counts);
    uint32_t object = 0;
    size_t beyond = 0;
    for (const ImportedInstance& instance : imported.instances)
    {
        if (instance.moving)
        {
            flattener.chooseHidingPlace();
            flattener.beginMoving();
        }
        const size_t first_triangle = flattener.triangleCount();
        for (size_t p = 0; p < instance.primitive_count; ++p)
        {
            const MeshPrimitive& primitive = imported.primitives[instance.first_primitive + p];
            beyond += !(instance.moving ? flattener.addMoving(primitive, instance.to_world, object, *instance.moving,
                                                              *imported.scene.motion)
                                        : flattener.add(primitive, instance.to_world, object));
        }
        if (instance.moving)
        {
            flattener.dropEmpty();
            addObject(*instance.moving, first_triangle, flattener.triangleCount(), *imported.scene.motion);
        }
        ++object;
    }
    if (beyond > 0)
        warnings.push_back({WarningKind::kBadGeometry, "",
                            fmt::format("nodes move {} primitives beyond the range of numbers", beyond),
                            "they are left out"});
    WorldMesh mesh = flattener.take();
    if (mesh.triangles.empty())
        return Error{ExitCode::kInvalid, "its default scene holds no triangles, so there is nothing to render"};
    mesh.object_count = object;
    if (flattener.flippedTriangles() > 0)
        warnings.push_back({WarningKind::kApproximated, "",
                            fmt::format("{} of {} triangles have normals against their winding; they were flipped",
                                        flattener.flippedTriangles(), mesh.triangles.size()),
                            ""});
    if (flattener.repairedNormals() > 0)
        warnings.push_back(
            {WarningKind::kBadGeometry, "",
             fmt::format("{} vertex normals have no direction and were replaced by that of their triangle",
                         flattener.repairedNormals()),
             ""});
    if (flattener.repairedValues() > 0)
        warnings.push_back({WarningKind::kBadGeometry, "",
                            fmt::format("{} texture coordinates or vertex colours are not finite and became 0",
                                        flattener.repairedValues()),
                            ""});
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
