#include "format/unfold_geometry.h"

#include "format/large_memory.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace package
{
namespace
{
/// Adds `run(first, end)` for pieces of 0 .. count.
template <typename Run>
void addPieces(UnfoldedGeometry::Tasks& tasks, size_t count, const Run& run)
{
    constexpr size_t kPiece = 1 << 15;
    for (size_t first = 0; first < count; first += kPiece)
        tasks.emplace_back([run, first, end = std::min(first + kPiece, count)]() -> Status { return run(first, end); });
}

// ---- The hierarchy -------------------------------------------------------------------------------------------------

/// Decodes node after node. Every node but the root is a child of one that came before, or there is an error.
class NodeUnfolder
{
public:
    NodeUnfolder(const Contents& contents, gpu::BvhNode* nodes) : stored_(contents.stored), nodes_(nodes)
    {
        const lumicut::fb::Vec3 &low = *contents.meta->bounds_min(), &high = *contents.meta->bounds_max();
        open_.push_back({0, 0, kInnerChild, rootBox({low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()})});
    }

    Status run()
    {
        while (!open_.empty())
        {
            const Child child = open_.back();
            open_.pop_back();
            if (Status status = child.kind == kInnerChild ? enter(child) : takeLeaf(child); !status)
                return status;
        }
        if (next_node_ < stored_.nodes.size())
            return invalid("chunk NODE: node {} has no parent", next_node_);
        if (next_leaf_ < stored_.leaf_triangles.size())
            return invalid("chunk LEAF: {} triangles, the leaves in chunk NODE hold {}", stored_.leaf_triangles.size(),
                           next_leaf_);
        if (const uint32_t need = traversalStackNeed(); need > gpu::kTraversalStackSize)
            return invalid("chunk NODE: traversal may need {} stack entries, shaders have {}", need,
                           gpu::kTraversalStackSize);
        return Success{};
    }

private:
    struct Child
    {
        uint32_t parent, number; // among its children
        uint8_t kind;
        NodeBox box;
    };

    void refer(const Child& child, uint32_t reference) { (&nodes_[child.parent].child.x)[child.number] = reference; }

    Status takeLeaf(const Child& child)
    {
        if (child.kind > kMostLeafTriangles)
            return invalid("chunk NODE: node {} child {} is of the unknown kind {}", child.parent, child.number,
                           child.kind);
        if (next_leaf_ + child.kind > std::min<size_t>(stored_.leaf_triangles.size(), size_t(gpu::kLeafFirstMask) + 1))
            return invalid("chunk NODE: node {} child {} is a leaf over triangles {} to {}, chunk LEAF has {}",
                           child.parent, child.number, next_leaf_, next_leaf_ + child.kind - 1,
                           stored_.leaf_triangles.size());
        refer(child, gpu::kLeafBit | uint32_t(child.kind - 1) << gpu::kLeafCountShift | uint32_t(next_leaf_));
        next_leaf_ += child.kind;
        return Success{};
    }

    Status enter(const Child& child)
    {
        const uint32_t index = next_node_;
        if (index >= stored_.nodes.size())
            return invalid("chunk NODE: node {} child {} is node {}, but there are only {}", child.parent, child.number,
                           index, stored_.nodes.size());
        if (index > 0)
            refer(child, index);
        ++next_node_;
        const StoredNode& node = stored_.nodes[index];
        NodePlanes planes;
        planes.child.fill(gpu::kNone);
        for (uint32_t axis = 0; axis < 3; ++axis)
        {
            const BoxSteps steps(child.box.low[axis], child.box.high[axis]);
            for (uint32_t c = 0; c < gpu::kBvhWidth; ++c)
            {
                const bool present = node.child[c] != kNoChild;
                planes.at[2 * axis][c] = present ? steps.low(node.low[axis][c]) : std::numeric_limits<float>::max();
                planes.at[2 * axis + 1][c] =
                    present ? steps.high(node.high[axis][c]) : std::numeric_limits<float>::lowest();
            }
        }
        nodes_[index] = std::bit_cast<gpu::BvhNode>(planes);
        for (uint32_t c = gpu::kBvhWidth; c-- > 0;) // the first child is the next to be visited
            if (node.child[c] != kNoChild)
            {
                open_.push_back({index, c, node.child[c], {}});
                for (uint32_t axis = 0; axis < 3; ++axis)
                {
                    const float low = planes.at[2 * axis][c], high = planes.at[2 * axis + 1][c];
                    if (!isFinite({low, high}) || low > high)
                        return invalid("chunk NODE: node {} child {} has bounds that are not finite or upside down",
                                       index, c);
                    open_.back().box.low[axis] = low;
                    open_.back().box.high[axis] = high;
                }
            }
        return Success{};
    }

    /// A traversal continues with one child and pushes the others, so a node with k children holds k - 1 entries while the
    /// child it visits first, in the worst case the most demanding one, is walked.
    uint32_t traversalStackNeed() const
    {
        std::vector<uint32_t> need(next_node_);
        for (size_t i = next_node_; i-- > 0;)
        {
            uint32_t present = 0, deepest = 0;
            for (const uint32_t reference :
                 {nodes_[i].child.x, nodes_[i].child.y, nodes_[i].child.z, nodes_[i].child.w})
            {
                if (reference == gpu::kNone)
                    continue;
                ++present;
                if ((reference & gpu::kLeafBit) == 0)
                    deepest = std::max(deepest, need[reference]);
            }
            need[i] = (present > 0 ? present - 1 : 0) + deepest;
        }
        return need[0];
    }

    const StoredArrays& stored_;
    gpu::BvhNode* nodes_;
    std::vector<Child> open_; // the next to be visited last
    uint32_t next_node_ = 0;
    size_t next_leaf_ = 0;
};

Status verifyLeaves(const StoredArrays& stored, size_t first, size_t end)
{
    for (size_t i = first; i < end; ++i)
        if (stored.leaf_triangles[i] >= stored.triangles.size())
            return invalid("chunk LEAF: entry {} is triangle {}, chunk TRIS has {}", i, stored.leaf_triangles[i],
                           stored.triangles.size());
    return Success{};
}

void unfoldLeaves(const StoredArrays& stored, gpu::BvhTriangle* out, size_t first, size_t end)
{
    for (size_t i = first; i < end; ++i)
    {
        const uint32_t index = stored.leaf_triangles[i];
        const StoredTriangle& t = stored.triangles[index];
        out[i] = {.v0 = stored.positions[t.vertices.x],
                  .triangle = index,
                  .v1 = stored.positions[t.vertices.y],
                  .material = t.material & kTriangleMaterialMask,
                  .v2 = stored.positions[t.vertices.z],
                  .flags = t.material >> kTriangleFlagsShift};
    }
}

// ---- Triangles and vertices ----------------------------------------------------------------------------------------

Status unfoldTriangles(const Contents& contents, gpu::Triangle* out, size_t first, size_t end)
{
    for (size_t i = first; i < end; ++i)
    {
        const StoredTriangle& t = contents.stored.triangles[i];
        for (const uint32_t vertex : {t.vertices.x, t.vertices.y, t.vertices.z})
            if (vertex >= contents.stored.vertices.size())
                return invalid("chunk TRIS: triangle {} refers to vertex {}, chunk VATT has {}", i, vertex,
                               contents.stored.vertices.size());
        const uint32_t index = t.material & kTriangleMaterialMask, flags = t.material >> kTriangleFlagsShift;
        if (index >= contents.materials.size())
            return invalid("chunk TRIS: triangle {} refers to material {}, chunk MATL has {}", i, index,
                           contents.materials.size());
        const uint32_t material_flags = contents.materials[index].flags;
        if ((flags & gpu::kTriangleAlpha) != 0 &&
            (material_flags & (gpu::kMaterialAlphaMask | gpu::kMaterialAlphaBlend)) == 0)
            return invalid("chunk TRIS: triangle {} is flagged for alpha but its material {} is opaque", i, index);
        if ((flags & gpu::kTriangleThin) != 0 && (material_flags & gpu::kMaterialThin) == 0)
            return invalid("chunk TRIS: triangle {} is flagged as thin but its material {} is not", i, index);
        out[i] = {t.vertices, gpu::kNone};
    }
    return Success{};
}

Status verifyFlags(const Contents& contents)
{
    uint32_t all = 0;
    for (const StoredTriangle& t : contents.stored.triangles)
        all |= t.material >> kTriangleFlagsShift;
    if (contents.meta->has_alpha() != ((all & gpu::kTriangleAlpha) != 0) ||
        contents.meta->has_thin() != ((all & gpu::kTriangleThin) != 0))
        return invalid("chunk META: has_alpha or has_thin disagree with the flags in chunk TRIS");
    return Success{};
}

bool isFiniteHalf(uint32_t bits)
{
    return (bits & 0x7c00u) != 0x7c00u;
}

Status verifyPositions(const Contents& contents, size_t first, size_t end)
{
    const lumicut::fb::Vec3 &low = *contents.meta->bounds_min(), &high = *contents.meta->bounds_max();
    for (size_t i = first; i < end; ++i)
    {
        const gpu::vec3& p = contents.stored.positions[i];
        if (!isFinite(p))
            return invalid("chunk VPOS: vertex {} is not finite", i);
        if (p.x < low.x() || p.y < low.y() || p.z < low.z() || p.x > high.x() || p.y > high.y() || p.z > high.z())
            return invalid("chunk VPOS: vertex {} lies outside the scene bounds in META", i);
    }
    return Success{};
}

Status unfoldVertices(const StoredArrays& stored, gpu::VertexAttributes* out, size_t first, size_t end)
{
    for (size_t i = first; i < end; ++i)
    {
        const StoredVertex& v = stored.vertices[i];
        const VertexExtras extras = stored.extras.empty() ? VertexExtras{} : stored.extras[i];
        if (!isFinite({v.uv0.x, v.uv0.y}))
            return invalid("chunk VATT: vertex {} has texture coordinates that are not finite", i);
        if (!isFinite({extras.uv1.x, extras.uv1.y}))
            return invalid("chunk VEXT: vertex {} has texture coordinates that are not finite", i);
        for (const uint32_t pair : {extras.color.x, extras.color.y})
            if (!isFiniteHalf(pair) || !isFiniteHalf(pair >> 16))
                return invalid("chunk VEXT: vertex {} has a colour that is not finite", i);
        out[i] = {.normal = v.normal, .tangent = v.tangent, .uv0 = v.uv0, .uv1 = extras.uv1, .color = extras.color};
    }
    return Success{};
}

/// Triangles learn from lights which is theirs.
Status assignLights(const Contents& contents, gpu::Triangle* triangles)
{
    for (uint32_t i = 0; i < contents.lights.size(); ++i)
    {
        const gpu::Light& light = contents.lights[i];
        if (light.kind != gpu::kLightTriangle && light.kind != gpu::kLightTriangleTwoSided)
            continue;
        if (light.triangle >= contents.triangles.size())
            return invalid("chunk LITE: light {} refers to triangle {}, chunk TRIS has {}", i, light.triangle,
                           contents.triangles.size());
        uint32_t& of_triangle = triangles[light.triangle].light;
        if (of_triangle != gpu::kNone)
            return invalid("chunk LITE: light {} claims triangle {}, which is light {} already", i, light.triangle,
                           of_triangle);
        of_triangle = i;
    }
    return Success{};
}

template <typename T>
std::span<const T> allocate(std::unique_ptr<T[]>& memory, size_t count)
{
    memory = std::make_unique_for_overwrite<T[]>(count);
    preferHugePages(memory.get(), count * sizeof(T));
    return {memory.get(), count};
}
} // namespace

UnfoldedGeometry::UnfoldedGeometry(Contents& contents)
{
    contents.bvh_nodes = allocate(nodes, contents.stored.nodes.size());
    contents.bvh_triangles = allocate(leaf_triangles, contents.stored.leaf_triangles.size());
    contents.triangles = allocate(triangles, contents.stored.triangles.size());
    contents.vertex_attributes = allocate(vertices, contents.stored.vertices.size());
}

void UnfoldedGeometry::addFirst(const Contents& contents, Tasks& tasks)
{
    const StoredArrays& stored = contents.stored;
    tasks.emplace_back([&contents, this] { return NodeUnfolder(contents, nodes.get()).run(); });
    addPieces(tasks, stored.leaf_triangles.size(),
              [&stored](size_t first, size_t end) { return verifyLeaves(stored, first, end); });
    addPieces(tasks, stored.triangles.size(),
              [&contents, this](size_t first, size_t end)
              { return unfoldTriangles(contents, triangles.get(), first, end); });
    tasks.emplace_back([&contents] { return verifyFlags(contents); });
    addPieces(tasks, stored.positions.size(),
              [&contents](size_t first, size_t end) { return verifyPositions(contents, first, end); });
    addPieces(tasks, stored.vertices.size(),
              [&stored, this](size_t first, size_t end) { return unfoldVertices(stored, vertices.get(), first, end); });
}

void UnfoldedGeometry::addSecond(const Contents& contents, Tasks& tasks)
{
    tasks.emplace_back([&contents, this] { return assignLights(contents, triangles.get()); });
    addPieces(tasks, contents.stored.leaf_triangles.size(),
              [&contents, this](size_t first, size_t end) -> Status
              {
                  unfoldLeaves(contents.stored, leaf_triangles.get(), first, end);
                  return Success{};
              });
}
} // namespace package
