// Builds the 4-wide bounding volume hierarchy (Embree's builder with spatial splits, collapsed from binary).
#pragma once
#include "compiler/scene_data.h"

#include <span>

struct Bvh
{
    std::vector<gpu::BvhNode> nodes; // node 0 is the root; children come after their parents, what moves comes last
    std::vector<gpu::BvhTriangle> triangles;
    float sah_cost = 0; // surface-area heuristic: expected node visits + triangle tests of a random ray
    uint32_t depth = 0;
    uint32_t traversal_stack = 0; // <= gpu::kTraversalStackSize
};

/// Objects that move have trees of their own, without spatial splits, below one of the objects, beside that of what stands
/// still.
/// @param triangle_flags [triangle_count] gpu::kTriangle* bits to store with each triangle
Bvh buildBvh(const WorldMesh& mesh, std::span<const uint32_t> triangle_flags);
