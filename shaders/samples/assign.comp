#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/lib/scene.glsl"
#include "shaders/lib/variation.glsl"
#include "shaders/samples/cluster_cube.glsl"
#include "shaders/samples/samples.h"

// Each point's nearest cluster by geometric variation: a range search, since eps >= alpha x distance, then sums of the
// clusters (Algorithm 2). One thread per point.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { ClusterParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Points { SamplePoint points[]; };
layout(set = 1, binding = 2) uniform usamplerBuffer Clusters;
layout(set = 1, binding = 3) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 4, scalar) readonly buffer Order { uint order[]; };
layout(set = 1, binding = 5, scalar) buffer Sums { ClusterSums sums[]; };
layout(set = 1, binding = 6, scalar) writeonly buffer Owners { uvec2 owners[]; }; // by point: cluster, bits of eps
layout(set = 1, binding = 7, scalar) readonly buffer Seeds { uint seeds[]; };     // by cluster: the point it started at, ascending
#include "shaders/lib/tree.glsl"

float alpha() { return params.alpha / view_scale.distance; } // of Eq. 2, per metre

Cluster loadCluster(uint index)
{
    uvec4 a = texelFetch(Clusters, int(index));
    return Cluster(uintBitsToFloat(a.xyz), a.w);
}

/// The cluster whose seed is next to the point in Z-order: near enough that the search around it is short.
uint neighbourInOrder(uint point)
{
    uint low = 0u, high = size.count; // seeds[low] <= point < seeds[high]
    while (high - low > 1u)
    {
        uint middle = (low + high) / 2u;
        if (seeds[middle] <= point)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void main()
{
    uint p = gl_GlobalInvocationID.x;
    if (p >= params.point_count)
        return;
    owners[p] = uvec2(kNone, 0u);
    if (points[p].pixel == kNone || size.count == 0u)
        return;
    vec3 x = points[p].position;
    vec3 n = unpackNormal(points[p].normal);
    uint owner = neighbourInOrder(p);
    float best = geometricVariation(alpha(), x, n, loadCluster(owner).position, unpackNormal(loadCluster(owner).normal));
    float radius2 = square(best / alpha());
    uint i, end;
    beginRanges(size.count);
    for (;;)
    {
        if (nextRange(x, radius2, i, end))
            for (;;)
            {
                uint cluster = order[i];
                Cluster c = loadCluster(cluster);
                float eps = geometricVariation(alpha(), x, n, c.position, unpackNormal(c.normal));
                if (eps < best || (eps == best && cluster < owner))
                {
                    best = eps;
                    owner = cluster;
                    radius2 = square(best / alpha());
                }
                if (++i == end)
                    break;
            }
        if (!hasRanges())
            break;
    }
    owners[p] = uvec2(owner, floatBitsToUint(best));
    vec3 center = loadCluster(owner).position, d = x - center;
    float width = cubeWidth(center);
    uvec3 position = uvec3(clamp(d / width + 0.5, 0.0, 1.0) * params.fixed_scale);
    uvec3 normal = uvec3((0.5 * n + 0.5) * params.fixed_scale);
    for (uint axis = 0u; axis < 3u; ++axis)
    {
        atomicAdd(sums[owner].position[axis], position[axis]);
        atomicAdd(sums[owner].normal[axis], normal[axis]);
    }
    atomicAdd(sums[owner].count, 1u);
    atomicMin(sums[owner].least_eps, floatBitsToUint(best));
    atomicAdd(sums[owner].distance, uint(min(1.0, length(d) / width) * params.fixed_scale));
}
