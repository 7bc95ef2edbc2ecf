#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/samples/cluster_cube.glsl"
#include "shaders/samples/samples.h"

// Moves every cluster's centre to the mean of its points. One thread per cluster; one without points stays.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { ClusterParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) buffer Sums { ClusterSums sums[]; };
layout(set = 1, binding = 2, scalar) buffer Clusters { Cluster clusters[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer Spheres { vec4 spheres[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count)
        return;
    ClusterSums s = sums[i];
    sums[i] = ClusterSums(uvec3(0u), 0u, uvec3(0u), 0u, 0xffffffffu, kNone);
    if (s.count == 0u)
        return;
    float scale = 1.0 / (params.fixed_scale * float(s.count));
    vec3 normal = 2.0 * scale * vec3(s.normal) - 1.0;
    if (dot(normal, normal) < 1e-6) // opposite normals: a centre that faces no way
        return;
    vec3 center = clusters[i].position;
    vec3 position = center + cubeWidth(center) * (scale * vec3(s.position) - 0.5);
    clusters[i] = Cluster(position, packNormal(normalize(normal)));
    spheres[i] = vec4(position, 0.0);
}
