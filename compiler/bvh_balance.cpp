#include "compiler/bvh_tree.h"
#include "format/check.h"

#include <algorithm>
#include <bit>
#include <vector>

namespace
{
gpu::vec3 center(const BinaryNode* node)
{
    return node->box.low * 0.5f + node->box.high * 0.5f;
}

void gather(BinaryNode& node, std::vector<BinaryNode*>& leaves, std::vector<BinaryNode*>& inner)
{
    if (node.isLeaf())
        return leaves.push_back(&node);
    inner.push_back(&node);
    gather(*node.children[0], leaves, inner);
    gather(*node.children[1], leaves, inner);
}

/// Halves `leaves` along the longest side of their centres until one is left. Takes inner nodes from the end of
/// `inner`.
BinaryNode* halve(std::span<BinaryNode*> leaves, std::vector<BinaryNode*>& inner)
{
    if (leaves.size() == 1)
        return leaves[0];
    Box centers;
    for (const BinaryNode* leaf : leaves)
        centers.grow(center(leaf));
    const gpu::vec3 size = centers.high - centers.low;
    const auto coordinate = [&](const BinaryNode* leaf)
    {
        const gpu::vec3 c = center(leaf);
        return size.x >= size.y && size.x >= size.z ? c.x : size.y >= size.z ? c.y : c.z;
    };
    std::stable_sort(leaves.begin(), leaves.end(),
                     [&](const BinaryNode* a, const BinaryNode* b) { return coordinate(a) < coordinate(b); });
    BinaryNode* node = inner.back();
    inner.pop_back();
    const size_t half = leaves.size() / 2;
    node->children = {halve(leaves.first(half), inner), halve(leaves.subspan(half), inner)};
    return node;
}

struct Shape
{
    uint32_t depth; // levels below the node
    uint32_t leaf_count;
};

Shape shape(const BinaryNode& node)
{
    if (node.isLeaf())
        return {0, 1};
    const Shape left = shape(*node.children[0]);
    const Shape right = shape(*node.children[1]);
    return {1 + std::max(left.depth, right.depth), left.leaf_count + right.leaf_count};
}

/// Of a tree of halves.
uint32_t leastDepth(const Shape& s)
{
    return uint32_t(std::bit_width(s.leaf_count - 1));
}
} // namespace

void limitDepth(BinaryNode& root, uint32_t depth)
{
    const Shape s = shape(root);
    if (s.depth <= depth)
        return;
    check(leastDepth(s) <= depth, "{} leaves in {} levels", s.leaf_count, depth);
    const auto fits = [&](const BinaryNode* child) { return leastDepth(shape(*child)) <= depth - 1; };
    if (fits(root.children[0]) && fits(root.children[1]))
    {
        limitDepth(*root.children[0], depth - 1);
        limitDepth(*root.children[1], depth - 1);
        return;
    }
    std::vector<BinaryNode*> leaves;
    std::vector<BinaryNode*> inner;
    gather(root, leaves, inner);
    std::reverse(inner.begin(), inner.end()); // so that `root` itself is taken first
    check(halve(leaves, inner) == &root, "root");
}
