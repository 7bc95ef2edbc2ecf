#include "compiler/bvh_moving.h"

#include "compiler/bvh_tree.h"
#include "format/check.h"
#include "format/stored_geometry.h"

#include <bit>
#include <deque>
#include <numeric>

namespace
{
using package::NodePlanes;

// ---- An object's binary tree ---------------------------------------------------------------------------------------

gpu::vec3 center(const Box& box)
{
    return box.low * 0.5f + box.high * 0.5f;
}

float along(const gpu::vec3& v, uint32_t axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

uint32_t longestAxis(const gpu::vec3& size)
{
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

/// Binned surface-area heuristic (Wald 2007), without spatial splits: equal input gives an equal tree.
class ObjectBuilder
{
public:
    ObjectBuilder(const WorldMesh& mesh, float padding) : mesh_(mesh), padding_(padding) {}

    BinaryNode* run(uint32_t first, uint32_t end)
    {
        std::vector<BinaryNode*> leaves;
        for (uint32_t i = first; i < end; ++i)
            leaves.push_back(leaf(i));
        return divide(leaves);
    }

private:
    static constexpr uint32_t kBins = 32;

    BinaryNode* leaf(uint32_t triangle)
    {
        BinaryNode& node = nodes_.emplace_back();
        node.triangle = triangle;
        const gpu::uvec3& t = mesh_.triangles[triangle];
        for (const uint32_t v : {t.x, t.y, t.z})
            node.box.grow(mesh_.positions[v]);
        const gpu::vec3 margin{padding_, padding_, padding_};
        node.box = {node.box.low - margin, node.box.high + margin};
        return &node;
    }

    BinaryNode* divide(std::span<BinaryNode*> leaves)
    {
        if (leaves.size() == 1)
            return leaves[0];
        const size_t half = split(leaves);
        BinaryNode& node = nodes_.emplace_back();
        node.children[0] = divide(leaves.first(half));
        node.children[1] = divide(leaves.subspan(half));
        return &node;
    }

    /// Orders the leaves so that the first part goes to one side. @return its size, at least 1
    static size_t split(std::span<BinaryNode*> leaves)
    {
        Box centers;
        for (const BinaryNode* node : leaves)
            centers.grow(center(node->box));
        const gpu::vec3 size = centers.high - centers.low;
        const uint32_t axis = longestAxis(size);
        const float length = along(size, axis), low = along(centers.low, axis);
        if (!(length > 0) || !std::isfinite(length))
            return leaves.size() / 2;
        const auto binOf = [&](const BinaryNode* node)
        { return std::min(uint32_t((along(center(node->box), axis) - low) / length * float(kBins)), kBins - 1); };
        const uint32_t last = cheapest(leaves, binOf);
        const auto middle =
            std::stable_partition(leaves.begin(), leaves.end(), [&](const BinaryNode* n) { return binOf(n) <= last; });
        const auto half = size_t(middle - leaves.begin());
        return half == 0 || half == leaves.size() ? leaves.size() / 2 : half;
    }

    /// The last bin of the first side where the sum of area times number is least.
    template <typename BinOf>
    static uint32_t cheapest(std::span<BinaryNode*> leaves, const BinOf& binOf)
    {
        std::array<Box, kBins> boxes;
        std::array<size_t, kBins> counts{};
        for (const BinaryNode* node : leaves)
        {
            boxes[binOf(node)].grow(node->box);
            ++counts[binOf(node)];
        }
        std::array<double, kBins> right{}; // cost of the bins from this one on
        Box box;
        size_t count = 0;
        for (uint32_t i = kBins; i-- > 0;)
        {
            if (counts[i] > 0)
                box.grow(boxes[i]);
            count += counts[i];
            right[i] = count == 0 ? 0 : box.halfArea() * double(count);
        }
        box = {};
        count = 0;
        uint32_t best = 0;
        double least = std::numeric_limits<double>::infinity();
        for (uint32_t i = 0; i + 1 < kBins; ++i)
        {
            if (counts[i] > 0)
                box.grow(boxes[i]);
            count += counts[i];
            const double cost = (count == 0 ? 0 : box.halfArea() * double(count)) + right[i + 1];
            if (count > 0 && count < leaves.size() && cost < least)
            {
                least = cost;
                best = i;
            }
        }
        return best;
    }

    const WorldMesh& mesh_;
    float padding_;
    std::deque<BinaryNode> nodes_;
};

// ---- The tree above them -------------------------------------------------------------------------------------------

Box boxOf(const gpu::BvhNode& node)
{
    const auto planes = std::bit_cast<NodePlanes>(node);
    Box box;
    for (size_t c = 0; c < gpu::kBvhWidth; ++c)
        if (planes.child[c] != gpu::kNone)
        {
            box.grow(gpu::vec3{planes.at[0][c], planes.at[2][c], planes.at[4][c]});
            box.grow(gpu::vec3{planes.at[1][c], planes.at[3][c], planes.at[5][c]});
        }
    return box;
}

class Joiner
{
public:
    explicit Joiner(const std::vector<Bvh>& objects) : objects_(objects)
    {
        for (const Bvh& object : objects)
            boxes_.push_back(boxOf(object.nodes[0]));
    }

    Bvh run(const Bvh& fixed)
    {
        std::vector<uint32_t> all(objects_.size());
        std::iota(all.begin(), all.end(), 0u);
        if (fixed.nodes.empty())
            emit(all);
        else
        {
            joined_.nodes.push_back(empty());
            setChild(0, 0, append(fixed), boxOf(fixed.nodes[0]));
            setChild(0, 1, emit(all), boxOf(all));
        }
        describe();
        return std::move(joined_);
    }

private:
    static gpu::BvhNode empty()
    {
        NodePlanes planes;
        planes.child.fill(gpu::kNone);
        for (size_t i = 0; i < 6; ++i)
            planes.at[i].fill(i % 2 == 0 ? Box{}.low.x : Box{}.high.x);
        return std::bit_cast<gpu::BvhNode>(planes);
    }

    void setChild(uint32_t node, size_t child, uint32_t reference, const Box& box)
    {
        auto planes = std::bit_cast<NodePlanes>(joined_.nodes[node]);
        planes.child[child] = reference;
        const std::array<float, 6> sides{box.low.x, box.high.x, box.low.y, box.high.y, box.low.z, box.high.z};
        for (size_t i = 0; i < 6; ++i)
            planes.at[i][child] = sides[i];
        joined_.nodes[node] = std::bit_cast<gpu::BvhNode>(planes);
    }

    /// @return the index of its root
    uint32_t append(const Bvh& tree)
    {
        const auto first_node = uint32_t(joined_.nodes.size());
        const auto first_slot = uint32_t(joined_.triangles.size());
        check(size_t(first_slot) + tree.triangles.size() - 1 <= gpu::kLeafFirstMask, "{} leaf triangles",
              size_t(first_slot) + tree.triangles.size());
        for (gpu::BvhNode node : tree.nodes)
        {
            for (uint32_t* child : {&node.child.x, &node.child.y, &node.child.z, &node.child.w})
                if (*child != gpu::kNone)
                    *child += (*child & gpu::kLeafBit) != 0 ? first_slot : first_node;
            joined_.nodes.push_back(node);
        }
        joined_.triangles.insert(joined_.triangles.end(), tree.triangles.begin(), tree.triangles.end());
        return first_node;
    }

    Box boxOf(std::span<const uint32_t> objects) const
    {
        Box box;
        for (const uint32_t object : objects)
            box.grow(boxes_[object]);
        return box;
    }
    static Box boxOf(const gpu::BvhNode& node) { return ::boxOf(node); }

    /// Halves along the longest side of the centres. @return the first half's size
    size_t halve(std::span<uint32_t> objects) const
    {
        Box centers;
        for (const uint32_t object : objects)
            centers.grow(center(boxes_[object]));
        const uint32_t axis = longestAxis(centers.high - centers.low);
        std::stable_sort(objects.begin(), objects.end(),
                         [&](uint32_t a, uint32_t b)
                         { return along(center(boxes_[a]), axis) < along(center(boxes_[b]), axis); });
        return objects.size() / 2;
    }

    /// @return the index of the root
    uint32_t emit(std::span<uint32_t> objects)
    {
        if (objects.size() == 1)
            return append(objects_[objects[0]]);
        const auto index = uint32_t(joined_.nodes.size());
        joined_.nodes.push_back(empty());
        const size_t half = halve(objects);
        size_t child = 0;
        for (const std::span<uint32_t> side : {objects.first(half), objects.subspan(half)})
        {
            const size_t quarter = side.size() == 1 ? 1 : halve(side);
            for (const std::span<uint32_t> part : {side.first(quarter), side.subspan(quarter)})
                if (!part.empty())
                {
                    const uint32_t reference = emit(part);
                    setChild(index, child++, reference, boxOf(part));
                }
        }
        return index;
    }

    /// Cost, depth and stack of the joined tree.
    void describe()
    {
        const double root_area = std::max(boxOf(joined_.nodes[0]).halfArea(), std::numeric_limits<double>::min());
        double cost = 0;
        std::vector<uint32_t> depth(joined_.nodes.size(), 1), stack(joined_.nodes.size());
        for (size_t i = joined_.nodes.size(); i-- > 0;)
        {
            const auto planes = std::bit_cast<NodePlanes>(joined_.nodes[i]);
            cost += boxOf(joined_.nodes[i]).halfArea();
            uint32_t present = 0, deepest = 0;
            for (size_t c = 0; c < gpu::kBvhWidth; ++c)
            {
                const uint32_t child = planes.child[c];
                if (child == gpu::kNone)
                    continue;
                ++present;
                if ((child & gpu::kLeafBit) == 0)
                {
                    deepest = std::max(deepest, stack[child]);
                    depth[i] = std::max(depth[i], depth[child] + 1);
                    continue;
                }
                const Box box{{planes.at[0][c], planes.at[2][c], planes.at[4][c]},
                              {planes.at[1][c], planes.at[3][c], planes.at[5][c]}};
                cost += box.halfArea() * ((child >> gpu::kLeafCountShift & gpu::kLeafCountMask) + 1);
            }
            stack[i] = present - 1 + deepest;
        }
        joined_.sah_cost = float(cost / root_area);
        joined_.depth = depth[0];
        joined_.traversal_stack = stack[0];
    }

    const std::vector<Bvh>& objects_;
    std::vector<Box> boxes_; // by object
    Bvh joined_;
};
} // namespace

Bvh buildObjectBvh(const WorldMesh& mesh, std::span<const uint32_t> triangle_flags, size_t object, float padding,
                   uint32_t most_stack)
{
    const uint32_t first = mesh.moving[object];
    const auto end = uint32_t(object + 1 < mesh.moving.size() ? mesh.moving[object + 1] : mesh.triangles.size());
    check(first < end, "object {} has no triangles", object);
    ObjectBuilder builder(mesh, padding);
    BinaryNode* const root = builder.run(first, end);
    return collapseToFit(*root, mesh, triangle_flags, most_stack);
}

Bvh joinMoving(Bvh fixed, const std::vector<Bvh>& objects)
{
    if (objects.empty())
        return fixed;
    Bvh joined = Joiner(objects).run(fixed);
    check(joined.traversal_stack <= gpu::kTraversalStackSize, "a stack of {}", joined.traversal_stack);
    return joined;
}
