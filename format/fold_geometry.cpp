#include "format/fold_geometry.h"

#include "format/check.h"
#include "format/large_memory.h"
#include "format/package_layout.h"

#include <algorithm>
#include <bit>

namespace package
{
namespace
{
/// Encodes node after node; boxes are relative to what a reader decodes of their parents'.
class NodeFolder
{
public:
    explicit NodeFolder(const Geometry& geometry) : geometry_(geometry), stored_(geometry.nodes.size()) {}

    std::vector<StoredNode> run()
    {
        visit(0, rootBox(geometry_.bounds_min, geometry_.bounds_max));
        while (!open_.empty())
        {
            const Child child = open_.back();
            open_.pop_back();
            if ((child.reference & gpu::kLeafBit) != 0)
            {
                check((child.reference & gpu::kLeafFirstMask) == next_leaf_, "leaf {:x} where {} is next",
                      child.reference, next_leaf_);
                next_leaf_ += (child.reference >> gpu::kLeafCountShift & gpu::kLeafCountMask) + 1;
            }
            else
                visit(child.reference, child.box);
        }
        check(next_node_ == stored_.size() && next_leaf_ == geometry_.leaf_triangles.size(),
              "{} of {} nodes, {} of {} leaf triangles", next_node_, stored_.size(), next_leaf_,
              geometry_.leaf_triangles.size());
        return std::move(stored_);
    }

private:
    struct Child
    {
        uint32_t reference;
        NodeBox box;
    };

    void visit(uint32_t index, const NodeBox& box)
    {
        check(index == next_node_, "node {} where {} is next", index, next_node_);
        ++next_node_;
        const auto planes = std::bit_cast<NodePlanes>(geometry_.nodes[index]);
        StoredNode& out = stored_[index];
        for (size_t c = gpu::kBvhWidth; c-- > 0;)
        {
            const uint32_t reference = planes.child[c];
            out.child[c] = reference == gpu::kNone ? kNoChild
                           : (reference & gpu::kLeafBit) == 0
                               ? kInnerChild
                               : uint8_t((reference >> gpu::kLeafCountShift & gpu::kLeafCountMask) + 1);
            Child child{reference, {}};
            for (size_t axis = 0; axis < 3; ++axis)
            {
                const float low = planes.at[2 * axis][c], high = planes.at[2 * axis + 1][c];
                out.low[axis][c] = out.high[axis][c] = 0;
                if (reference == gpu::kNone)
                    continue;
                check(low >= box.low[axis] && high <= box.high[axis], "node {} child {} from {} to {} in {} to {}",
                      index, c, low, high, box.low[axis], box.high[axis]);
                const BoxSteps steps(box.low[axis], box.high[axis]);
                out.low[axis][c] = steps.toLow(low);
                out.high[axis][c] = steps.toHigh(high);
                child.box.low[axis] = steps.low(out.low[axis][c]);
                child.box.high[axis] = steps.high(out.high[axis][c]);
            }
            if (reference != gpu::kNone)
                open_.push_back(child);
        }
    }

    const Geometry& geometry_;
    std::vector<StoredNode> stored_;
    std::vector<Child> open_; // the next to be visited last
    uint32_t next_node_ = 0, next_leaf_ = 0;
};

bool isDefault(const gpu::VertexAttributes& v)
{
    const VertexExtras standard;
    return v.uv1.x == 0 && v.uv1.y == 0 && v.color.x == standard.color.x && v.color.y == standard.color.y;
}
} // namespace

StoredGeometry foldGeometry(const Geometry& geometry)
{
    StoredGeometry out{.nodes = NodeFolder(geometry).run(),
                       .leaf_triangles = {},
                       .triangles = {},
                       .positions = geometry.positions,
                       .vertices = {},
                       .extras = {}};
    reserveLarge(out.triangles, geometry.triangles.size());
    for (const gpu::uvec3& vertices : geometry.triangles)
        out.triangles.push_back({vertices, 0});
    reserveLarge(out.leaf_triangles, geometry.leaf_triangles.size());
    for (const gpu::BvhTriangle& t : geometry.leaf_triangles)
    {
        check(t.material <= kTriangleMaterialMask, "material {}", t.material);
        out.leaf_triangles.push_back(t.triangle);
        out.triangles[t.triangle].material = t.material | t.flags << kTriangleFlagsShift;
    }
    reserveLarge(out.vertices, geometry.attributes.size());
    for (const gpu::VertexAttributes& v : geometry.attributes)
        out.vertices.push_back({v.normal, v.tangent, v.uv0});
    if (!std::all_of(geometry.attributes.begin(), geometry.attributes.end(), isDefault))
        for (const gpu::VertexAttributes& v : geometry.attributes)
            out.extras.push_back({v.uv1, v.color});
    return out;
}

std::vector<ChunkSource> StoredGeometry::chunks() const
{
    const auto bytes = [](const auto& array) { return std::as_bytes(std::span(array)); };
    return {{kBvhNodesChunk, 0, bytes(nodes)},
            {kLeafTrianglesChunk, 0, bytes(leaf_triangles)},
            {kTrianglesChunk, 0, bytes(triangles)},
            {kPositionsChunk, 0, bytes(positions)},
            {kVertexAttributesChunk, 0, bytes(vertices)},
            {kVertexExtrasChunk, 0, bytes(extras)}};
}
} // namespace package
