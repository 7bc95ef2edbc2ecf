// The hierarchy must be a tree that a fixed traversal stack can walk, over triangles that exist.
#include "format/package_verify.h"

#include <algorithm>
#include <vector>

namespace package
{
namespace
{
std::array<uint32_t, gpu::kBvhWidth> children(const gpu::BvhNode& node)
{
    return {node.child.x, node.child.y, node.child.z, node.child.w};
}

struct Bounds
{
    gpu::vec3 low, high;
};

std::array<Bounds, gpu::kBvhWidth> childBounds(const gpu::BvhNode& n)
{
    return {{{{n.min_x.x, n.min_y.x, n.min_z.x}, {n.max_x.x, n.max_y.x, n.max_z.x}},
             {{n.min_x.y, n.min_y.y, n.min_z.y}, {n.max_x.y, n.max_y.y, n.max_z.y}},
             {{n.min_x.z, n.min_y.z, n.min_z.z}, {n.max_x.z, n.max_y.z, n.max_z.z}},
             {{n.min_x.w, n.min_y.w, n.min_z.w}, {n.max_x.w, n.max_y.w, n.max_z.w}}}};
}

Status verifyBounds(const Bounds& b, uint32_t reference, size_t node, uint32_t child)
{
    const bool finite = isFinite(b.low) && isFinite(b.high);
    if (reference == gpu::kNone)
    {
        if (!(b.low.x > b.high.x && b.low.y > b.high.y && b.low.z > b.high.z))
            return invalid("chunk NODE: node {} child {} is absent but its bounds are not empty", node, child);
    }
    else if (!finite || b.low.x > b.high.x || b.low.y > b.high.y || b.low.z > b.high.z)
        return invalid("chunk NODE: node {} child {} has bounds that are not finite or upside down", node, child);
    return Success{};
}

Status verifyChild(const Contents& contents, uint32_t reference, size_t node, uint32_t child,
                   std::vector<bool>& has_parent)
{
    if (reference == gpu::kNone)
        return Success{};
    if ((reference & gpu::kLeafBit) != 0)
    {
        const uint64_t first = reference & gpu::kLeafFirstMask;
        const uint64_t count = (reference >> gpu::kLeafCountShift & gpu::kLeafCountMask) + 1;
        if (first + count > contents.bvh_triangles.size())
            return invalid("chunk NODE: node {} child {} is a leaf over triangles {} to {}, chunk BTRI has {}", node,
                           child, first, first + count - 1, contents.bvh_triangles.size());
        return Success{};
    }
    if (reference >= contents.bvh_nodes.size())
        return invalid("chunk NODE: node {} child {} points to node {}, but there are only {}", node, child, reference,
                       contents.bvh_nodes.size());
    if (reference <= node)
        return invalid("chunk NODE: node {} child {} points to node {}: children must come after their parent", node,
                       child, reference);
    if (has_parent[reference])
        return invalid("chunk NODE: node {} child {} points to node {}, which already has a parent", node, child,
                       reference);
    has_parent[reference] = true;
    return Success{};
}

/// A traversal continues with one child and pushes the others, so a node with k children holds k - 1 entries while the
/// child it visits first, in the worst case the most demanding one, is walked.
uint32_t traversalStackNeed(std::span<const gpu::BvhNode> nodes)
{
    std::vector<uint32_t> need(nodes.size());
    for (size_t i = nodes.size(); i-- > 0;)
    {
        uint32_t present = 0;
        uint32_t deepest = 0;
        for (const uint32_t reference : children(nodes[i]))
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
} // namespace

Status verifyBvhNodes(const Contents& contents)
{
    std::vector<bool> has_parent(contents.bvh_nodes.size());
    for (size_t i = 0; i < contents.bvh_nodes.size(); ++i)
    {
        const auto references = children(contents.bvh_nodes[i]);
        const auto bounds = childBounds(contents.bvh_nodes[i]);
        for (uint32_t c = 0; c < gpu::kBvhWidth; ++c)
        {
            if (Status child = verifyChild(contents, references[c], i, c, has_parent); !child)
                return child;
            if (Status box = verifyBounds(bounds[c], references[c], i, c); !box)
                return box;
        }
        if (i > 0 && !has_parent[i]) // parents come first, so it would be known by now
            return invalid("chunk NODE: node {} has no parent", i);
    }
    const uint32_t need = traversalStackNeed(contents.bvh_nodes);
    if (need > gpu::kTraversalStackSize)
        return invalid("chunk NODE: traversal may need {} stack entries, shaders have {}", need,
                       gpu::kTraversalStackSize);
    return Success{};
}

Status verifyBvhTriangles(const Contents& contents)
{
    const lumicut::fb::Meta& meta = *contents.meta;
    const lumicut::fb::Vec3& low = *meta.bounds_min();
    const lumicut::fb::Vec3& high = *meta.bounds_max();
    uint32_t all_flags = 0;
    for (size_t i = 0; i < contents.bvh_triangles.size(); ++i)
    {
        const gpu::BvhTriangle& t = contents.bvh_triangles[i];
        for (const gpu::vec3& v : {t.v0, t.v1, t.v2})
        {
            if (!isFinite(v))
                return invalid("chunk BTRI: triangle {} has a vertex that is not finite", i);
            if (v.x < low.x() || v.y < low.y() || v.z < low.z() || v.x > high.x() || v.y > high.y() || v.z > high.z())
                return invalid("chunk BTRI: triangle {} lies outside the scene bounds in META", i);
        }
        if (t.triangle >= contents.triangles.size())
            return invalid("chunk BTRI: triangle {} refers to surface {}, chunk TRIS has {}", i, t.triangle,
                           contents.triangles.size());
        if (t.material >= contents.materials.size())
            return invalid("chunk BTRI: triangle {} refers to material {}, chunk MATL has {}", i, t.material,
                           contents.materials.size());
        const uint32_t material_flags = contents.materials[t.material].flags;
        if (t.flags > (gpu::kTriangleAlpha | gpu::kTriangleThin))
            return invalid("chunk BTRI: triangle {} has unknown flags ({:#x})", i, t.flags);
        if ((t.flags & gpu::kTriangleAlpha) != 0 &&
            (material_flags & (gpu::kMaterialAlphaMask | gpu::kMaterialAlphaBlend)) == 0)
            return invalid("chunk BTRI: triangle {} is flagged for alpha but its material {} is opaque", i, t.material);
        if ((t.flags & gpu::kTriangleThin) != 0 && (material_flags & gpu::kMaterialThin) == 0)
            return invalid("chunk BTRI: triangle {} is flagged as thin but its material {} is not", i, t.material);
        all_flags |= t.flags;
    }
    if (meta.has_alpha() != ((all_flags & gpu::kTriangleAlpha) != 0) ||
        meta.has_thin() != ((all_flags & gpu::kTriangleThin) != 0))
        return invalid("chunk META: has_alpha or has_thin disagree with the flags in chunk BTRI");
    return Success{};
}
} // namespace package
