// Geometry from the arrays that shaders read into those that a package stores.
#pragma once
#include "format/package_write.h"
#include "format/stored_geometry.h"

#include <span>
#include <vector>

namespace package
{
/// What buildBvh() and flatten() make. Nodes are in the order of StoredNode, leaves in that of their nodes.
struct Geometry
{
    gpu::vec3 bounds_min, bounds_max; // of the positions, as META has them
    std::span<const gpu::BvhNode> nodes;
    std::span<const gpu::BvhTriangle> leaf_triangles; // every triangle in one at least
    std::span<const gpu::uvec3> triangles;            // vertices
    std::span<const gpu::vec3> positions;             // by vertex
    std::span<const gpu::VertexAttributes> attributes;
};

struct StoredGeometry
{
    std::vector<StoredNode> nodes;
    std::vector<uint32_t> leaf_triangles;
    std::vector<StoredTriangle> triangles;
    std::span<const gpu::vec3> positions; // borrowed
    std::vector<StoredVertex> vertices;
    std::vector<VertexExtras> extras; // empty where all are as by default

    std::vector<ChunkSource> chunks() const;
};

/// Boxes are rounded outwards, by less than a 65535th of the box around them; all else comes back as it was.
StoredGeometry foldGeometry(const Geometry& geometry);
} // namespace package
