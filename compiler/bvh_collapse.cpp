#include "compiler/bvh_tree.h"
#include "compiler/parallel.h"
#include "format/check.h"
#include "format/large_memory.h"

#include <algorithm>
#include <unordered_map>
#include <vector>

namespace
{
constexpr uint32_t kWidth = gpu::kBvhWidth;
// Relative costs of one node visit and one triangle test.
constexpr double kNodeCost = 1;
constexpr double kTriangleCost = 1;

/// State of the dynamic program for one binary subtree, bottom-up.
struct Plan
{
    std::array<double, kWidth>
        cost{}; // [i]: least cost of representing it as a forest of at most i + 1 nodes or leaves
    std::array<uint32_t, kMaxLeafTriangles> triangles{}; // of the whole subtree while it could still be one leaf
    uint32_t triangle_count = 0;                         // 0: too many for a leaf
};

bool becomesLeaf(const BinaryNode& node)
{
    return node.isLeaf() || node.choice.share_of_node == 0;
}

/// Both children's triangles, each once. @return whether one leaf can hold them
bool mergeTriangles(const Plan& left, const Plan& right, Plan& result)
{
    if (left.triangle_count == 0 || right.triangle_count == 0)
        return false;
    std::array<uint32_t, 2 * kMaxLeafTriangles> merged{};
    const auto end =
        std::set_union(left.triangles.begin(), left.triangles.begin() + left.triangle_count, right.triangles.begin(),
                       right.triangles.begin() + right.triangle_count, merged.begin());
    const auto count = size_t(end - merged.begin());
    if (count > kMaxLeafTriangles)
        return false;
    std::copy(merged.begin(), end, result.triangles.begin());
    result.triangle_count = uint32_t(count);
    return true;
}

Plan planLeaf(const BinaryNode& node)
{
    Plan result;
    result.triangles[0] = node.triangle;
    result.triangle_count = 1;
    result.cost.fill(node.box.halfArea() * kTriangleCost);
    return result;
}

/// Sets the node's box and choice from its children.
Plan planInner(BinaryNode& node, const Plan& left, const Plan& right)
{
    node.box = node.children[0]->box;
    node.box.grow(node.children[1]->box);
    const double area = node.box.halfArea();
    std::array<double, kWidth> split_cost{};
    std::array<uint8_t, kWidth> split_share{};
    for (uint32_t count = 2; count <= kWidth; ++count)
    {
        split_cost[count - 1] = std::numeric_limits<double>::infinity();
        for (uint32_t share = 1; share < count; ++share)
        {
            const double cost = left.cost[share - 1] + right.cost[count - share - 1];
            if (cost < split_cost[count - 1])
            {
                split_cost[count - 1] = cost;
                split_share[count - 1] = uint8_t(share);
            }
        }
    }
    Plan result;
    node.choice.share_of_node = split_share[kWidth - 1];
    result.cost[0] = split_cost[kWidth - 1] + area * kNodeCost;
    if (mergeTriangles(left, right, result))
    {
        const double leaf_cost = area * kTriangleCost * result.triangle_count;
        if (leaf_cost <= result.cost[0])
            node.choice.share_of_node = 0;
        result.cost[0] = std::min(leaf_cost, result.cost[0]);
    }
    for (uint32_t i = 1; i < kWidth; ++i)
    {
        const bool split = split_cost[i] < result.cost[i - 1];
        result.cost[i] = split ? split_cost[i] : result.cost[i - 1];
        node.choice.share_of_forest[i - 1] = split ? split_share[i] : 0;
    }
    return result;
}

Plan plan(BinaryNode& node)
{
    if (node.isLeaf())
        return planLeaf(node);
    const Plan left = plan(*node.children[0]);
    return planInner(node, left, plan(*node.children[1]));
}

using Plans = std::unordered_map<const BinaryNode*, Plan>;

Plan planAbove(BinaryNode& node, const Plans& known)
{
    if (const auto found = known.find(&node); found != known.end())
        return found->second;
    const Plan left = planAbove(*node.children[0], known);
    return planInner(node, left, planAbove(*node.children[1], known));
}

/// plan(), large subtrees side by side.
void planTree(BinaryNode& root)
{
    std::vector<BinaryNode*> subtrees{&root};
    for (uint32_t level = 0; level < 8 && thread_limit > 1; ++level)
    {
        std::vector<BinaryNode*> below;
        for (BinaryNode* node : subtrees)
            if (node->isLeaf())
                below.push_back(node);
            else
                below.insert(below.end(), node->children.begin(), node->children.end());
        subtrees = std::move(below);
    }
    std::vector<Plan> plans(subtrees.size());
    parallelFor(subtrees.size(), [&](size_t i) { plans[i] = plan(*subtrees[i]); });
    Plans known;
    for (size_t i = 0; i < subtrees.size(); ++i)
        known.emplace(subtrees[i], plans[i]);
    planAbove(root, known);
}

class Collapse
{
public:
    Collapse(const WorldMesh& mesh, std::span<const uint32_t> triangle_flags)
        : mesh_(mesh), triangle_flags_(triangle_flags)
    {
    }

    Bvh run(BinaryNode& root)
    {
        planTree(root);
        if (mesh_.moving.empty())
        {
            reserveLarge(bvh_.nodes, mesh_.triangles.size() / 4 + 1);
            reserveLarge(bvh_.triangles, mesh_.triangles.size() + mesh_.triangles.size() / 4);
        }
        const double root_area = std::max(root.box.halfArea(), std::numeric_limits<double>::min());
        bvh_.nodes.emplace_back();
        Trees children;
        if (becomesLeaf(root))
            children.add(root);
        else
            distribute(root, kWidth, root.choice.share_of_node, children);
        bvh_.traversal_stack = emitNode(0, children, root.box.halfArea(), 1);
        bvh_.sah_cost = float(cost_ / root_area);
        return std::move(bvh_);
    }

private:
    /// The binary subtrees that become children of one wide node.
    struct Trees
    {
        std::array<const BinaryNode*, kWidth> nodes{};
        uint32_t count = 0;

        void add(const BinaryNode& node) { nodes[count++] = &node; }
    };

    /// Appends at most `count` trees that represent `node`'s children, `share` of them from its first child.
    static void distribute(const BinaryNode& node, uint32_t count, uint32_t share, Trees& out)
    {
        forest(*node.children[0], share, out);
        forest(*node.children[1], count - share, out);
    }

    static void forest(const BinaryNode& node, uint32_t count, Trees& out)
    {
        if (node.isLeaf())
            count = 1;
        while (count > 1 && node.choice.share_of_forest[count - 2] == 0)
            --count;
        if (count == 1)
            out.add(node);
        else
            distribute(node, count, node.choice.share_of_forest[count - 2], out);
    }

    /// The triangles below `node`, each once, in ascending order.
    static void gatherTriangles(const BinaryNode& node, std::array<uint32_t, kMaxLeafTriangles>& found, uint32_t& count)
    {
        if (!node.isLeaf())
        {
            gatherTriangles(*node.children[0], found, count);
            gatherTriangles(*node.children[1], found, count);
            return;
        }
        const auto end = found.begin() + count;
        const auto place = std::lower_bound(found.begin(), end, node.triangle);
        if (place != end && *place == node.triangle)
            return;
        std::move_backward(place, end, end + 1);
        *place = node.triangle;
        ++count;
    }

    uint32_t emitLeaf(const BinaryNode& leaf)
    {
        const uint32_t first = uint32_t(bvh_.triangles.size());
        std::array<uint32_t, kMaxLeafTriangles> indices{};
        uint32_t count = 0;
        gatherTriangles(leaf, indices, count);
        check(first + count - 1 <= gpu::kLeafFirstMask, "{} leaf triangles", first + count);
        for (const uint32_t index : std::span(indices).first(count))
        {
            const gpu::uvec3& v = mesh_.triangles[index];
            bvh_.triangles.push_back({.v0 = mesh_.positions[v.x],
                                      .triangle = index,
                                      .v1 = mesh_.positions[v.y],
                                      .material = mesh_.materials[index],
                                      .v2 = mesh_.positions[v.z],
                                      .flags = triangle_flags_[index]});
        }
        cost_ += leaf.box.halfArea() * kTriangleCost * count;
        return gpu::kLeafBit | (count - 1) << gpu::kLeafCountShift | first;
    }

    /// @return the traversal stack entries that the node's subtree needs
    uint32_t emitNode(uint32_t index, const Trees& children, double area, uint32_t depth)
    {
        cost_ += area * kNodeCost;
        bvh_.depth = std::max(bvh_.depth, depth);
        std::array<uint32_t, kWidth> references;
        std::array<Box, kWidth> boxes; // empty
        references.fill(gpu::kNone);
        uint32_t deepest = 0;
        for (uint32_t i = 0; i < children.count; ++i)
        {
            const BinaryNode& child = *children.nodes[i];
            boxes[i] = child.box;
            if (becomesLeaf(child))
            {
                references[i] = emitLeaf(child);
                continue;
            }
            references[i] = uint32_t(bvh_.nodes.size());
            bvh_.nodes.emplace_back();
            Trees grandchildren;
            distribute(child, kWidth, child.choice.share_of_node, grandchildren);
            deepest = std::max(deepest, emitNode(references[i], grandchildren, child.box.halfArea(), depth + 1));
        }
        const auto& b = boxes;
        bvh_.nodes[index] = {.min_x = {b[0].low.x, b[1].low.x, b[2].low.x, b[3].low.x},
                             .max_x = {b[0].high.x, b[1].high.x, b[2].high.x, b[3].high.x},
                             .min_y = {b[0].low.y, b[1].low.y, b[2].low.y, b[3].low.y},
                             .max_y = {b[0].high.y, b[1].high.y, b[2].high.y, b[3].high.y},
                             .min_z = {b[0].low.z, b[1].low.z, b[2].low.z, b[3].low.z},
                             .max_z = {b[0].high.z, b[1].high.z, b[2].high.z, b[3].high.z},
                             .child = {references[0], references[1], references[2], references[3]}};
        return children.count - 1 + deepest;
    }

    const WorldMesh& mesh_;
    std::span<const uint32_t> triangle_flags_;
    Bvh bvh_;
    double cost_ = 0;
};
} // namespace

Bvh collapse(BinaryNode& root, const WorldMesh& mesh, std::span<const uint32_t> triangle_flags)
{
    return Collapse(mesh, triangle_flags).run(root);
}

Bvh collapseToFit(BinaryNode& root, const WorldMesh& mesh, std::span<const uint32_t> triangle_flags,
                  uint32_t most_stack)
{
    Bvh bvh = collapse(root, mesh, triangle_flags);
    for (uint32_t depth = most_stack - 8; bvh.traversal_stack > most_stack; depth -= 4)
    {
        limitDepth(root, depth);
        bvh = collapse(root, mesh, triangle_flags);
    }
    return bvh;
}
