// The hierarchy from the cache, where it was built from the same triangles before.
#pragma once
#include "compiler/build_bvh.h"
#include "compiler/cache.h"

/// As buildBvh().
Bvh cachedBvh(const Cache& cache, const WorldMesh& mesh, std::span<const uint32_t> triangle_flags);
