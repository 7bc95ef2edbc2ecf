#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/samples/samples.h"

// Takes the points of samples that are kept out of those that new samples are placed for. One thread per point.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { ClusterParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Points { SamplePoint points[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Flags { uint flags[]; }; // by old sample: 1 where it is kept
layout(set = 1, binding = 2, scalar) buffer Claims { uvec2 claims[]; };
layout(set = 1, binding = 3, scalar) buffer Sums { ClusterSums sums[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer Rest { SamplePoint rest[]; };

void main()
{
    uint p = gl_GlobalInvocationID.x;
    if (p >= params.point_count)
        return;
    SamplePoint point = points[p];
    uvec2 claim = claims[p];
    if (claim.x != kNone && flags[claim.x] != 0u)
    {
        point.pixel = kNone;
        if (claim.y == sums[claim.x].least_eps)
            atomicMin(sums[claim.x].nearest, p);
    }
    else
        claims[p] = uvec2(kNone, 0u);
    rest[p] = point;
}
