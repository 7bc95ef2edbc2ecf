#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/rays/rays.h"
#include "shaders/tree/tree.h"

// All inner nodes at once from the sorted codes (Karras 2012): each covers one shared_bits prefix, that is, one cell of cyclic
// spatial-median splits. One thread per inner node.

layout(local_size_x = kTreeGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Keys { uint keys[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Nodes { TreeNode nodes[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer LeafParents { uint leaf_parents[]; }; // node | kTreeLeafBit: right child
layout(set = 1, binding = 4, scalar) writeonly buffer NodeParents { uint node_parents[]; };

/// Length of the shared_bits prefix of codes i and j, the index serving as a tie-breaker; -1 outside.
int prefix(int i, int j)
{
    if (j < 0 || j >= int(size.count))
        return -1;
    uint difference = keys[i] ^ keys[j];
    return difference != 0u ? 31 - findMSB(difference) : 63 - findMSB(uint(i) ^ uint(j));
}

void main()
{
    int i = int(gl_GlobalInvocationID.x);
    if (i + 1 >= int(size.count))
        return;
    int direction = prefix(i, i + 1) > prefix(i, i - 1) ? 1 : -1;
    int outside = prefix(i, i - direction);
    int reach = 2;
    while (prefix(i, i + reach * direction) > outside)
        reach *= 2;
    int span = 0;
    for (int step = reach / 2; step >= 1; step /= 2)
        if (prefix(i, i + (span + step) * direction) > outside)
            span += step;
    int j = i + span * direction;
    int shared_bits = prefix(i, j);
    int split = 0;
    for (int step = span; step > 1;)
    {
        step = (step + 1) / 2;
        if (prefix(i, i + (split + step) * direction) > shared_bits)
            split += step;
    }
    int left = i + split * direction + min(direction, 0);
    int first = min(i, j), last = max(i, j);
    bool left_leaf = left == first, right_leaf = left + 1 == last;
    nodes[i].left = uint(left) | (left_leaf ? kTreeLeafBit : 0u);
    nodes[i].right = uint(left + 1) | (right_leaf ? kTreeLeafBit : 0u);
    nodes[i].first = uint(first);
    nodes[i].count = uint(last - first + 1);
    if (left_leaf)
        leaf_parents[left] = uint(i);
    else
        node_parents[left] = uint(i);
    if (right_leaf)
        leaf_parents[left + 1] = uint(i) | kTreeLeafBit;
    else
        node_parents[left + 1] = uint(i) | kTreeLeafBit;
}
