// What moves one vertex, as the package's chunks MVTX, MINF and MMRF have it.
#pragma once
#include "compiler/mesh.h"
#include "compiler/motion.h"

/// A vertex of a primitive in one of its triangles.
struct MovingCorner
{
    const MovingVertices& moving;
    uint32_t vertex = 0;
    gpu::uvec3 triangle{};           // as wound in world space at rest
    bool flipped = false;            // its normal is against the winding and gets turned
    bool mirrored = false;           // at rest, by what places it
    bool negative_bitangent = false; // in the mesh's space, after all that
};

/// Appends it with its influences and morph offsets.
void appendMovingVertex(const MovingCorner& corner, const MovingPlace& place, MotionData& motion);
