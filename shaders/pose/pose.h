// Moving geometry at a pose. Shared by runtime/stages/pose.cpp and shaders/pose/*.comp.
#ifndef SHADERS_POSE_H
#define SHADERS_POSE_H
#include "format/gpu_motion.h"
#include "format/gpu_scene.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kPoseGroupSize = 64u;

// Where a child hangs in the hierarchy: kBvhWidth * node + number of the child.

struct PosedLeaf // a leaf of the moving part of the hierarchy
{
    uint link;      // where it hangs
    uint reference; // the child reference there
};
GPU_SIZE(PosedLeaf, 8);

struct PosedObject // a moving object
{
    uint link; // where it hangs
    uint node; // root of the object's part of the hierarchy
};
GPU_SIZE(PosedObject, 8);

struct PosedEmitter // a moving triangle that is a light
{
    uint light; // index into Lights
    uint slot;  // index into BvhTriangles
};
GPU_SIZE(PosedEmitter, 8);

struct PosedTarget // a moving object that caustic photons are aimed at
{
    uint target; // index into CausticTargets
    uint node;   // root of the object's part of the hierarchy
};
GPU_SIZE(PosedTarget, 8);

struct TriangleCorners // metres, world space
{
    vec3 v0;
    vec3 v1;
    vec3 v2;
};
GPU_SIZE(TriangleCorners, 36);

struct PoseParams
{
    uint vertex_count;  // that move
    uint first_vertex;  // index into VertexAttributes of the first of them
    uint leaf_count;    // PosedLeaf
    uint first_slot;    // index into BvhTriangles of the first moving triangle
    uint first_node;    // index of the first moving node; its ancestors but the root are none
    uint emitter_count; // PosedEmitter
    uint target_count;  // PosedTarget
    uint object_count;  // PosedObject
    uint slot_count;    // BvhTriangles that move
};
GPU_SIZE(PoseParams, 36);

GPU_NAMESPACE_END
#endif
