// Geometry that moves, as a package stores it and as kernels read it. It comes last: the last vertices, triangles, leaf slots
// and nodes of a scene that has motion are those that move, as they are at rest; here is what moves them.
#ifndef FORMAT_GPU_MOTION_H
#define FORMAT_GPU_MOTION_H
#include "format/gpu_types.h"

GPU_NAMESPACE_BEGIN

// A moving vertex lies at sum over its influences of weight * (bone * (position + sum over its morphs of weight * offset)).
// A rigid vertex has one influence of weight 1; a skinned one those of all its JOINTS_n and WEIGHTS_n.

struct MovingVertex // chunk MVTX, in the order of the last vertices of VPOS
{
    vec3 position;        // in the mesh's own space
    uint first_influence; // into MINF; its influences end where the next vertex' begin
    vec3 normal;          // unit, in the mesh's own space
    uint first_morph;     // into MMRF; likewise
    vec4 tangent;         // unit, w: sign of the bitangent; xyz 0: none
};
GPU_SIZE(MovingVertex, 48);
GPU_OFFSET(MovingVertex, normal, 16);
GPU_OFFSET(MovingVertex, tangent, 32);

struct Influence // chunk MINF
{
    uint bone; // index into the pose's bones
    float weight;
};
GPU_SIZE(Influence, 8);

struct MorphOffset // chunk MMRF, of one vertex and one target; only those that are not 0
{
    vec3 position;
    uint weight; // index into the pose's morph weights
    vec3 normal;
    vec3 tangent;
};
GPU_SIZE(MorphOffset, 40);

struct BoneMatrix // rows: a point p of the mesh goes to (dot(x, (p, 1)), ...), in the package's units of length
{
    vec4 x;
    vec4 y;
    vec4 z;
};
GPU_SIZE(BoneMatrix, 48);

GPU_NAMESPACE_END
#endif
