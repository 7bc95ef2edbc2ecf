// A binary tree over spheres, built on the GPU, for photons, cut nodes, cluster centres and samples.
#pragma once
#include "runtime/gpu/gpu.h"
#include "runtime/scene_gpu.h"
#include "runtime/stages/primitives.h"
#include "shaders/tree/tree.h"

#include <array>

/// Of kernels that climb a tree (lib/climb.glsl).
Constant climbConstant(const Device& device);

class Tree
{
public:
    /// @param name of its buffers, @param max_count spheres at most
    Tree(const Device& device, std::string_view name, uint32_t max_count, const Scratch& scratch = {});

    static uint64_t scratchBytes(const Device& device, uint32_t max_count);

    /// Builds the tree over spheres[0, size.count).
    /// @param spheres vec4[max_count]: centre and radius, metres; points have radius 0
    /// @param size gpu::QueueSize, ready for dispatch
    void record(Recorder& rec, const Buffer& spheres, const Buffer& size) const;
    /// The same where a kernel has filled keys(), and order() with 0, 1, ...; nodes are the cells of the keys' prefixes.
    void recordKeyed(Recorder& rec, const Buffer& spheres, const Buffer& size, uint32_t key_bits) const;
    /// The same tree after the spheres have moved a little: it holds them all, if no longer in the order of their keys.
    void refit(Recorder& rec, const Buffer& spheres, const Buffer& size) const;

    const Buffer& keys() const { return keys_; }   // uint[count], in scratch memory
    const Buffer& nodes() const { return nodes_; } // gpu::TreeNode[count - 1]
    const Buffer& order() const { return order_; } // uint[count]: which sphere is the i-th of the sorted ones
    const Buffer& leafParents() const
    {
        return leaf_parents_;
    } // uint[count]: node | kTreeLeafBit where it is the right child
    const Buffer& nodeParents() const { return node_parents_; } // uint[count - 1]; the root's is undefined

private:
    Kernel keys_kernel_, hierarchy_, bounds_;
    RadixSort sort_;
    Buffer keys_, order_, nodes_, leaf_parents_, node_parents_, arrivals_;
};
