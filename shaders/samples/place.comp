#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/samples/cluster_cube.glsl"
#include "shaders/samples/samples.h"

// A sample at the shading point that is nearest to its cluster's centre. One thread per sample.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { ClusterParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Occupied { uint occupied[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Sums { ClusterSums sums[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Points { SamplePoint points[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer Samples { Sample samples[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer Spheres { vec4 spheres[]; };
layout(set = 1, binding = 6, scalar) readonly buffer Clusters { Cluster clusters[]; };

// A round cluster of radius rho has a mean distance of 2/3 rho; its neighbours lie at 2 rho, the next ones at 3.5 and 4 rho.
// With a reach of 4, that is 2.7 rho, every place shares about seven samples.

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count)
        return;
    ClusterSums s = sums[occupied[i]];
    SamplePoint point = points[s.nearest];
    vec3 center = clusters[occupied[i]].position;
    float away = viewDistance(center), distance_ = float(s.distance) / (params.fixed_scale * float(s.count)) * cubeWidth(center);
    float support = clamp(params.reach * distance_, 1e-3 * away, 0.5 * away);
    samples[i] = Sample(point.position, point.normal, vec3(0.0), support, 0.0, point.pixel);
    spheres[i] = vec4(point.position, support);
}
