// The hierarchy while it is being built: a binary tree of pointers, a triangle in every leaf.
#pragma once
#include "compiler/build_bvh.h"
#include "compiler/vector_math.h"

#include <array>
#include <limits>
#include <span>

inline constexpr uint32_t kMaxLeafTriangles = 4; // of the 4-wide tree

struct Box
{
    gpu::vec3 low{std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
                  std::numeric_limits<float>::max()};
    gpu::vec3 high{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest(),
                   std::numeric_limits<float>::lowest()};

    void grow(const gpu::vec3& p)
    {
        low = min(low, p);
        high = max(high, p);
    }
    void grow(const Box& b)
    {
        low = min(low, b.low);
        high = max(high, b.high);
    }
    double halfArea() const
    {
        const double x = double(high.x) - low.x;
        const double y = double(high.y) - low.y;
        const double z = double(high.z) - low.z;
        return x * y + y * z + z * x;
    }
};

/// How collapse() represents an inner node of the binary tree.
struct WideChoice
{
    uint8_t share_of_node = 0; // where it becomes a wide node, its first child's part of the four; 0: it becomes a leaf
    std::array<uint8_t, gpu::kBvhWidth - 1>
        share_of_forest{}; // [n - 2]: first child's part of n trees; 0: n - 1 suffice
};

struct BinaryNode
{
    Box box;                               // in a leaf as built, in an inner node once collapse() has been there
    std::array<BinaryNode*, 2> children{}; // null in a leaf
    uint32_t triangle = 0;                 // of a leaf, which holds it or a part of it
    WideChoice choice;                     // of an inner node, once collapse() has been there

    bool isLeaf() const { return children[0] == nullptr; }
};

/// Splits `box` (about all or a part of the triangle) at `position` along `axis` and shrinks both halves to the parts
/// of the triangle inside them, rounded to nearest.
void splitTriangleBox(const std::array<gpu::vec3, 3>& corners, const Box& box, uint32_t axis, float position, Box& left,
                      Box& right);

/// Rebuilds what lies too deep in the tree from halves of equal size, so that no leaf is more than `depth` levels below
/// `root`. Leaves stay as they are; the top of the tree stays as it is for as long as the rest then still fits.
/// @param depth at least log2 of the number of leaves
void limitDepth(BinaryNode& root, uint32_t depth);

/// Turns the binary tree into 4-wide nodes so that the surface-area heuristic is least (Wald et al. 2008; the dynamic
/// program of Ylitie et al. 2017, section 3.1), in depth-first order. Sets the boxes of inner nodes.
Bvh collapse(BinaryNode& root, const WorldMesh& mesh, std::span<const uint32_t> triangle_flags);

/// The same, of a tree that is made less deep until traversal needs no more than `most_stack` entries.
Bvh collapseToFit(BinaryNode& root, const WorldMesh& mesh, std::span<const uint32_t> triangle_flags,
                  uint32_t most_stack);
