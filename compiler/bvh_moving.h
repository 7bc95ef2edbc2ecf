// The part of the hierarchy that moves: a tree for each object, and one above them.
#pragma once
#include "compiler/build_bvh.h"

/// The tree of one object that moves, each triangle in one leaf. At most `most_stack` traversal entries.
/// @param padding around every triangle
Bvh buildObjectBvh(const WorldMesh& mesh, std::span<const uint32_t> triangle_flags, size_t object, float padding,
                   uint32_t most_stack);

/// One tree of all: `fixed` comes first, the objects' last, in the order of a walk. Its root is one of both.
/// @param fixed of what stands still; without nodes where nothing does
Bvh joinMoving(Bvh fixed, const std::vector<Bvh>& objects);
