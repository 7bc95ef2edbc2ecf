#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/samples/samples.h"

// Takes the points of samples that are kept out of those that new samples are placed for. The others remember which kept
// sample is the nearest: it has them where no new one comes nearer, so that new clusters do not reach across kept ones.
// One thread per point.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { ClusterParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Points { SamplePoint points[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Flags { uint flags[]; }; // by old sample: 1 where it is kept
layout(set = 1, binding = 2, scalar) buffer Claims { uvec2 claims[]; }; // as classify has left them; loses kKeptBit and samples that go
layout(set = 1, binding = 3, scalar) buffer Sums { ClusterSums sums[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer Rest { SamplePoint rest[]; };

void main()
{
    uint p = gl_GlobalInvocationID.x;
    if (p >= params.point_count)
        return;
    SamplePoint point = points[p];
    uvec2 claim = claims[p];
    uint nearest = claim.x & ~kKeptBit;
    bool kept = claim.x != kNone && flags[nearest] != 0u;
    if (kept && claim.x >= kKeptBit)
    {
        point.pixel = kNone;
        if (claim.y == sums[nearest].least_eps)
            atomicMin(sums[nearest].nearest, p);
    }
    claims[p] = kept ? uvec2(nearest, claim.y) : uvec2(kNone, 0u);
    rest[p] = point;
}
