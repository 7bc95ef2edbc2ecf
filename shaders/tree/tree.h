// A binary tree over spheres (points have radius 0). Shared by runtime/stages/tree.cpp, lib/tree.glsl and shaders/tree/*.comp.
#ifndef SHADERS_TREE_H
#define SHADERS_TREE_H
#include "format/gpu_types.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kTreeGroupSize = 64u;
GPU_CONST uint kTreeKeyBits = 30u; // of Morton codes: 10 an axis
GPU_CONST uint kTreeBucket = 4u;   // spheres that are tested one by one instead of through more nodes
GPU_CONST uint kTreeLeafBit = 0x80000000u;

// Inner node i of n - 1; node 0 is the root. It covers the contiguous range [first, first + count) of the sorted spheres;
// its left child covers [first, left_index], the right one the rest, where left_index is the left child's index without
// kTreeLeafBit: the left child is inner node or sphere left_index, the right child left_index + 1 (Karras 2012, "Maximizing
// Parallelism in the Construction of BVHs, Octrees, and k-d Trees").
struct TreeNode
{
    vec3 left_min; // bounds of the left child's spheres, metres
    uint left;     // index | kTreeLeafBit where the child is a single sphere
    vec3 left_max;
    uint right;
    vec3 right_min;
    uint first;
    vec3 right_max;
    uint count;
};
GPU_SIZE(TreeNode, 64);

GPU_NAMESPACE_END
#endif
