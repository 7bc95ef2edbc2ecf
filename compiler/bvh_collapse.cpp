#include "compiler/bvh_tree.h"
#include "format/check.h"

#include <algorithm>
#include <vector>

namespace
{
constexpr uint32_t kWidth = gpu::kBvhWidth;
// Relative costs of one node visit and one triangle test.
constexpr double kNodeCost = 1;
constexpr double kTriangleCost = 1;

/// The dynamic program's table for one binary node. `cost[i]`: least cost of representing the subtree as a forest of at
/// most i + 1 wide nodes or leaves.
struct Plan
{
    std::array<double, kWidth> cost{};
    std::array<uint8_t, kWidth> left_share{}; // trees given to child 0 where the forest is split; 0: use cost[i - 1]
    bool as_leaf = false;                     // how cost[0] is reached
    uint8_t split_for_node = 0;               // left share where the node itself becomes a wide node
    std::array<uint32_t, kMaxLeafTriangles> triangles{}; // of the whole subtree while it could still be one leaf
    uint32_t triangle_count = 0;                         // 0: too many for a leaf
};

class Collapse
{
public:
    Collapse(const WorldMesh& mesh, std::span<const uint32_t> triangle_flags)
        : mesh_(mesh), triangle_flags_(triangle_flags)
    {
    }

    Bvh run(BinaryNode& root)
    {
        const uint32_t root_plan = plan(root);
        const double root_area = std::max(root.box.halfArea(), std::numeric_limits<double>::min());
        bvh_.nodes.emplace_back();
        std::vector<Tree> children;
        if (plans_[root_plan].as_leaf)
            children.push_back({&root, root_plan});
        else
            distribute(root, root_plan, kWidth, plans_[root_plan].split_for_node, children);
        bvh_.traversal_stack = emitNode(0, children, root.box.halfArea(), 1);
        bvh_.sah_cost = float(cost_ / root_area);
        return std::move(bvh_);
    }

private:
    struct Tree // a binary subtree that becomes one child of a wide node
    {
        BinaryNode* node;
        uint32_t plan;
    };

    uint32_t plan(BinaryNode& node)
    {
        const uint32_t index = uint32_t(plans_.size());
        plans_.emplace_back();
        node_plans_.push_back({});
        Plan result;
        if (node.isLeaf())
        {
            result.triangles[0] = node.triangle;
            result.triangle_count = 1;
            result.as_leaf = true;
            result.cost.fill(node.box.halfArea() * kTriangleCost);
        }
        else
        {
            const uint32_t left = plan(*node.children[0]);
            const uint32_t right = plan(*node.children[1]);
            node_plans_[index] = {left, right};
            node.box = node.children[0]->box;
            node.box.grow(node.children[1]->box);
            planInner(node, plans_[left], plans_[right], result);
        }
        plans_[index] = std::move(result);
        return index;
    }

    void planInner(const BinaryNode& node, const Plan& left, const Plan& right, Plan& result) const
    {
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
        result.split_for_node = split_share[kWidth - 1];
        result.cost[0] = split_cost[kWidth - 1] + area * kNodeCost;
        if (mergeTriangles(left, right, result))
        {
            const double leaf_cost = area * kTriangleCost * result.triangle_count;
            result.as_leaf = leaf_cost <= result.cost[0];
            result.cost[0] = std::min(leaf_cost, result.cost[0]);
        }
        for (uint32_t i = 1; i < kWidth; ++i)
        {
            const bool split = split_cost[i] < result.cost[i - 1];
            result.cost[i] = split ? split_cost[i] : result.cost[i - 1];
            result.left_share[i] = split ? split_share[i] : 0;
        }
    }

    /// Both children's triangles, each once. @return whether one leaf can hold them
    static bool mergeTriangles(const Plan& left, const Plan& right, Plan& result)
    {
        if (left.triangle_count == 0 || right.triangle_count == 0)
            return false;
        std::array<uint32_t, 2 * kMaxLeafTriangles> merged{};
        const auto end =
            std::set_union(left.triangles.begin(), left.triangles.begin() + left.triangle_count,
                           right.triangles.begin(), right.triangles.begin() + right.triangle_count, merged.begin());
        const auto count = size_t(end - merged.begin());
        if (count > kMaxLeafTriangles)
            return false;
        std::copy(merged.begin(), end, result.triangles.begin());
        result.triangle_count = uint32_t(count);
        return true;
    }

    /// Appends the at most `count` trees that represent `node`'s children, `share` of them from its first child.
    void distribute(const BinaryNode& node, uint32_t plan_index, uint32_t count, uint32_t share, std::vector<Tree>& out)
    {
        const auto [left, right] = node_plans_[plan_index];
        forest(*node.children[0], left, share, out);
        forest(*node.children[1], right, count - share, out);
    }

    void forest(BinaryNode& node, uint32_t plan_index, uint32_t count, std::vector<Tree>& out)
    {
        const Plan& p = plans_[plan_index];
        while (count > 1 && p.left_share[count - 1] == 0)
            --count;
        if (count == 1)
            out.push_back({&node, plan_index});
        else
            distribute(node, plan_index, count, p.left_share[count - 1], out);
    }

    uint32_t emitLeaf(const Plan& p, double area)
    {
        const uint32_t first = uint32_t(bvh_.triangles.size());
        const uint32_t count = p.triangle_count;
        check(first + count - 1 <= gpu::kLeafFirstMask, "{} leaf triangles", first + count);
        for (const uint32_t index : std::span(p.triangles).first(count))
        {
            const gpu::uvec3& v = mesh_.triangles[index];
            bvh_.triangles.push_back({.v0 = mesh_.positions[v.x],
                                      .triangle = index,
                                      .v1 = mesh_.positions[v.y],
                                      .material = mesh_.materials[index],
                                      .v2 = mesh_.positions[v.z],
                                      .flags = triangle_flags_[index]});
        }
        cost_ += area * kTriangleCost * count;
        return gpu::kLeafBit | (count - 1) << gpu::kLeafCountShift | first;
    }

    /// @return the traversal stack entries that the node's subtree needs
    uint32_t emitNode(uint32_t index, const std::vector<Tree>& children, double area, uint32_t depth)
    {
        cost_ += area * kNodeCost;
        bvh_.depth = std::max(bvh_.depth, depth);
        std::array<uint32_t, kWidth> references;
        std::array<Box, kWidth> boxes; // empty
        references.fill(gpu::kNone);
        uint32_t deepest = 0;
        for (size_t i = 0; i < children.size(); ++i)
        {
            const auto [node, plan_index] = children[i];
            boxes[i] = node->box;
            if (plans_[plan_index].as_leaf)
            {
                references[i] = emitLeaf(plans_[plan_index], node->box.halfArea());
                continue;
            }
            references[i] = uint32_t(bvh_.nodes.size());
            bvh_.nodes.emplace_back();
            std::vector<Tree> grandchildren;
            distribute(*node, plan_index, kWidth, plans_[plan_index].split_for_node, grandchildren);
            deepest = std::max(deepest, emitNode(references[i], grandchildren, node->box.halfArea(), depth + 1));
        }
        const auto& b = boxes;
        bvh_.nodes[index] = {.min_x = {b[0].low.x, b[1].low.x, b[2].low.x, b[3].low.x},
                             .max_x = {b[0].high.x, b[1].high.x, b[2].high.x, b[3].high.x},
                             .min_y = {b[0].low.y, b[1].low.y, b[2].low.y, b[3].low.y},
                             .max_y = {b[0].high.y, b[1].high.y, b[2].high.y, b[3].high.y},
                             .min_z = {b[0].low.z, b[1].low.z, b[2].low.z, b[3].low.z},
                             .max_z = {b[0].high.z, b[1].high.z, b[2].high.z, b[3].high.z},
                             .child = {references[0], references[1], references[2], references[3]}};
        return uint32_t(children.size()) - 1 + deepest;
    }

    const WorldMesh& mesh_;
    std::span<const uint32_t> triangle_flags_;
    std::vector<Plan> plans_;
    std::vector<std::pair<uint32_t, uint32_t>> node_plans_; // of both children
    Bvh bvh_;
    double cost_ = 0;
};
} // namespace

Bvh collapse(BinaryNode& root, const WorldMesh& mesh, std::span<const uint32_t> triangle_flags)
{
    return Collapse(mesh, triangle_flags).run(root);
}
