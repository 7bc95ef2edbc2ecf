// Geometry as a package stores it. Shaders read a triangle's corners, material and flags with every leaf that holds it, and
// boxes as floats; a package has each vertex and triangle once, and boxes relative to the box around them. The reader unfolds
// that into the arrays of gpu_scene.h.
#pragma once
#include "format/gpu_scene.h"

#include <array>
#include <cstdint>

namespace package
{
inline constexpr uint8_t kNoChild = 0; // StoredNode.child: 1 to kMostLeafTriangles is a leaf of as many triangles
inline constexpr uint8_t kMostLeafTriangles = gpu::kLeafCountMask + 1;
inline constexpr uint8_t kInnerChild = 255;

/// Chunk NODE, in the order of a walk that visits a node before its children and these by their number. Leaves take their
/// triangles from chunk LEAF in the same order.
struct StoredNode
{
    std::array<std::array<uint16_t, gpu::kBvhWidth>, 3>
        low; // [axis][child], steps up from the low side of this node's box
    std::array<std::array<uint16_t, gpu::kBvhWidth>, 3> high; // steps down from its high side
    std::array<uint8_t, gpu::kBvhWidth> child;
};
static_assert(sizeof(StoredNode) == 52);

/// Chunk TRIS.
struct StoredTriangle
{
    gpu::uvec3 vertices;
    uint32_t material; // bits 0 to 29; above them gpu::kTriangle*
};
static_assert(sizeof(StoredTriangle) == 16);
inline constexpr uint32_t kTriangleFlagsShift = 30;
inline constexpr uint32_t kTriangleMaterialMask = (1u << kTriangleFlagsShift) - 1;

/// Chunk VATT: members of gpu::VertexAttributes.
struct StoredVertex
{
    uint32_t normal;
    uint32_t tangent;
    gpu::vec2 uv0;
};
static_assert(sizeof(StoredVertex) == 16);

/// Chunk VEXT, which is left out where every vertex has these values.
struct VertexExtras
{
    gpu::vec2 uv1{0, 0};
    gpu::uvec2 color{0x3c003c00, 0x3c003c00}; // white
};
static_assert(sizeof(VertexExtras) == 16);

/// Members of gpu::BvhNode by number.
struct NodePlanes
{
    std::array<std::array<float, gpu::kBvhWidth>, 6> at; // [2 * axis + (high ? 1 : 0)][child]
    std::array<uint32_t, gpu::kBvhWidth> child;
};
static_assert(sizeof(NodePlanes) == sizeof(gpu::BvhNode));

/// A node's box, by axis.
struct NodeBox
{
    std::array<float, 3> low, high;
};

/// The root's: META's bounds, wider on every side by 2^-20 of their largest coordinate.
NodeBox rootBox(const gpu::vec3& bounds_min, const gpu::vec3& bounds_max);

/// The planes that a child's steps stand for, along one axis of its node's box. The products are exact in double precision:
/// whether they are contracted with the sum or not, every machine decodes the same boxes.
class BoxSteps
{
public:
    BoxSteps(float low, float high) : low_(low), high_(high), step_(float((high_ - low_) / kMostSteps)) {}

    float low(uint32_t steps) const { return float(low_ + steps * step_); }
    float high(uint32_t steps) const { return float(high_ - steps * step_); }
    /// The most steps for which low() is not above, or high() not below `plane`, which lies in the box.
    uint16_t toLow(float plane) const;
    uint16_t toHigh(float plane) const;

private:
    static constexpr double kMostSteps = 65535;
    double low_, high_, step_;
};
} // namespace package
