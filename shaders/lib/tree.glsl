// Range search in a tree over spheres: the one traversal that every nearest-neighbour and density query uses.
// The kernel declares `usamplerBuffer TreeNodes` before it includes this. Functions only.
#ifndef LIB_TREE_GLSL
#define LIB_TREE_GLSL
#include "shaders/tree/tree.h"

const uint kTreeStackSize = 64u; // 32 key bits at most, then ties by index: depth 32 + 32

TreeNode loadTreeNode(uint index)
{
    int row = int(4u * index);
    uvec4 a = texelFetch(TreeNodes, row), b = texelFetch(TreeNodes, row + 1);
    uvec4 c = texelFetch(TreeNodes, row + 2), d = texelFetch(TreeNodes, row + 3);
    return TreeNode(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz), c.w, uintBitsToFloat(d.xyz), d.w);
}

// Ranges still to be visited: node and count with the side in the top bit. Module scope: no copies.
uvec2 tree_stack[kTreeStackSize];
uint tree_depth;

/// Starts a search among `count` spheres. Loops over what it finds test at their end (see lib/bvh.glsl why):
///     beginRanges(count);
///     for (;;)
///     {
///         if (nextRange(..., i, end))
///             for (;;)
///             {
///                 ... i ...
///                 if (++i == end)
///                     break;
///             }
///         if (!hasRanges())
///             break;
///     }
void beginRanges(uint count)
{
    tree_depth = 0u;
    if (count > 0u)
        tree_stack[tree_depth++] = uvec2(0u, count);
}

/// Whether there may be another range.
bool hasRanges() { return tree_depth > 0u; }

/// Between two boxes.
float boxDistance2(vec3 a_low, vec3 a_high, vec3 b_low, vec3 b_high)
{
    vec3 outside = max(max(b_low - a_high, a_low - b_high), vec3(0.0));
    return dot(outside, outside);
}

/// First of an entry's spheres: a right child's range starts at its own index, a left child's ends there; the root is both.
uint firstOf(uvec2 entry)
{
    return (entry.y & kTreeLeafBit) != 0u || entry.x == 0u ? entry.x : entry.x + 1u - entry.y;
}

bool isBucket(uvec2 entry) { return (entry.y & ~kTreeLeafBit) <= kTreeBucket; }

/// The next range [first, end) of sorted spheres, nearer ones first, whose bounds come within sqrt(radius2) of the box from
/// low to high; radius2 may shrink from call to call. Ranges are short (kTreeBucket) and disjoint.
/// @return false when there is none left
bool nextRange(vec3 low, vec3 high, float radius2, out uint first, out uint end)
{
    const uvec2 kNowhere = uvec2(0u);
    uvec2 top = tree_depth > 0u ? tree_stack[--tree_depth] : kNowhere;
    if (!isBucket(top))
        for (;;)
        {
            first = firstOf(top);
            end = first + (top.y & ~kTreeLeafBit);
            TreeNode node = loadTreeNode(top.x);
            uint left = node.left & ~kTreeLeafBit;
            uvec2 near = uvec2(left, left + 1u - first), far = uvec2(left + 1u, (end - left - 1u) | kTreeLeafBit);
            float near2 = boxDistance2(low, high, node.left_min, node.left_max);
            float far2 = boxDistance2(low, high, node.right_min, node.right_max);
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
            top = near;
            if (near2 > radius2) // then far is farther, too
                top = tree_depth > 0u ? tree_stack[--tree_depth] : kNowhere;
            if (isBucket(top))
                break;
        }
    first = firstOf(top);
    end = first + (top.y & ~kTreeLeafBit);
    return first < end;
}

/// The same around a point.
bool nextRange(vec3 p, float radius2, out uint first, out uint end) { return nextRange(p, p, radius2, first, end); }

#endif
