// Geometry from the arrays that a package stores into those that shaders read, verified on the way.
#pragma once
#include "format/package_verify.h"

#include <functional>
#include <memory>
#include <vector>

namespace package
{
/// What shaders read, in memory of its own.
struct UnfoldedGeometry
{
    std::unique_ptr<gpu::BvhNode[]> nodes;
    std::unique_ptr<gpu::BvhTriangle[]> leaf_triangles;
    std::unique_ptr<gpu::Triangle[]> triangles;
    std::unique_ptr<gpu::VertexAttributes[]> vertices;

    /// Allocates what `contents` stores and lets its spans refer to it.
    explicit UnfoldedGeometry(Contents& contents);

    using Tasks = std::vector<std::function<Status()>>;
    /// Adds what may run side by side: everything but the corners of leaves and the lights of triangles.
    void addFirst(const Contents& contents, Tasks& tasks);
    /// Adds the rest, for which the first must have succeeded.
    void addSecond(const Contents& contents, Tasks& tasks);
};
} // namespace package
