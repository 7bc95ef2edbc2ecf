// The body of samples/assign.comp and samples/adopt.comp, which differ in whether points may belong to kept samples.

#include "shaders/samples/cluster_cube.glsl"

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
    uvec2 claim = claimOf(p);
    owners[p] = claim;
    if (points[p].pixel == kNone || size.count == 0u)
        return;
    vec3 x = points[p].position;
    vec3 n = unpackNormal(points[p].normal);
    uint owner = claim.x;
    float best = uintBitsToFloat(claim.y);
    if (owner == kNone)
    {
        owner = neighbourInOrder(p);
        best = geometricVariation(alpha(), x, n, clusters[owner].position, unpackNormal(clusters[owner].normal));
    }
    float radius2 = square(best / alpha());
    uint first, end;
    beginRanges(size.count);
    while (nextRange(x, radius2, first, end))
        for (uint i = first; i < end; ++i)
        {
            uint cluster = order[i];
            float eps = geometricVariation(alpha(), x, n, clusters[cluster].position, unpackNormal(clusters[cluster].normal));
            if (eps < best || (eps == best && cluster < owner))
            {
                best = eps;
                owner = cluster;
                radius2 = square(best / alpha());
            }
        }
    if (owner == claim.x) // the kept sample's still: kNone has become some cluster
        return;
    owners[p] = uvec2(owner, floatBitsToUint(best));
    vec3 d = x - clusters[owner].position;
    float width = cubeWidth(clusters[owner].position);
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
