#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/samples/samples.h"

// A cluster at every seed. One thread per seed.

layout(local_size_x = kSamplesGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Seeds { uint seeds[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Points { SamplePoint points[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer Clusters { Cluster clusters[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer Spheres { vec4 spheres[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer Sums { ClusterSums sums[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count)
        return;
    SamplePoint point = points[seeds[i]];
    clusters[i] = Cluster(point.position, point.normal);
    spheres[i] = vec4(point.position, 0.0);
    sums[i] = ClusterSums(uvec3(0u), 0u, uvec3(0u), 0u, 0xffffffffu, kNone);
}
