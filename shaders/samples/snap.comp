#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/samples/samples.h"

// The point of least variation of every cluster; of equal ones the first. One thread per point.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { ClusterParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Owners { uvec2 owners[]; };
layout(set = 1, binding = 1, scalar) buffer Sums { ClusterSums sums[]; };

void main()
{
    uint p = gl_GlobalInvocationID.x;
    if (p >= params.point_count || owners[p].x == kNone)
        return;
    if (owners[p].y == sums[owners[p].x].least_eps)
        atomicMin(sums[owners[p].x].nearest, p);
}
