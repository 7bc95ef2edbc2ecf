// Range search in a tree over spheres: the one traversal that every nearest-neighbour and density query uses.
// The kernel declares `buffer TreeNodes { TreeNode tree_nodes[]; }` before it includes this. Functions only.
#ifndef LIB_TREE_GLSL
#define LIB_TREE_GLSL
#include "shaders/tree/tree.h"

const uint kTreeStackSize = 64u; // 30 key bits, then ties by index: depth 30 + 32 at most

// Ranges still to be visited: node and count with the side in the top bit. Module scope: no copies.
uvec2 tree_stack[kTreeStackSize];
uint tree_depth;

/// Starts a search among `count` spheres.
void beginRanges(uint count)
{
    tree_depth = 0u;
    if (count > 0u)
        tree_stack[tree_depth++] = uvec2(0u, count);
}

float boxDistance2(vec3 p, vec3 low, vec3 high)
{
    vec3 outside = max(max(low - p, p - high), vec3(0.0));
    return dot(outside, outside);
}

/// The next range [first, end) of sorted spheres, nearer ones first, whose bounds come within sqrt(radius2) of p; radius2 may shrink from call to
/// call. Ranges are short (kTreeBucket) and disjoint. @return false when there is none left
bool nextRange(vec3 p, float radius2, out uint first, out uint end)
{
    while (tree_depth > 0u)
    {
        uvec2 top = tree_stack[--tree_depth];
        uint count = top.y & ~kTreeLeafBit;
        // A right child's range starts at its own index, a left child's ends there; the root is both.
        first = (top.y & kTreeLeafBit) != 0u || top.x == 0u ? top.x : top.x + 1u - count;
        end = first + count;
        if (count <= kTreeBucket)
            return true;
        TreeNode node = tree_nodes[top.x];
        uint left = node.left & ~kTreeLeafBit;
        uvec2 near = uvec2(left, left + 1u - first), far = uvec2(left + 1u, (end - left - 1u) | kTreeLeafBit);
        float near2 = boxDistance2(p, node.left_min, node.left_max), far2 = boxDistance2(p, node.right_min, node.right_max);
        if (far2 < near2)
        {
            uvec2 swapped = near;
            near = far;
            far = swapped;
            float swapped2 = near2;
            near2 = far2;
            far2 = swapped2;
        }
        if (far2 <= radius2)
            tree_stack[tree_depth++] = far;
        if (near2 <= radius2)
            tree_stack[tree_depth++] = near;
    }
    return false;
}

#endif
