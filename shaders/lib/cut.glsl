// Reading the illumination cut. The kernel declares `buffer CutSize { QueueSize cut_size; }` and the usamplerBuffers
// TreeNodes (of the cut) and CutNodes before it includes this. Functions only.
#ifndef LIB_CUT_GLSL
#define LIB_CUT_GLSL
#include "shaders/lib/cut_node.glsl"
#include "shaders/lib/tree.glsl"

CutNode loadCutNode(uint index)
{
    uvec4 a = texelFetch(CutNodes, int(2u * index)), b = texelFetch(CutNodes, int(2u * index + 1u));
    return CutNode(uintBitsToFloat(a.xyz), uintBitsToFloat(a.w), uintBitsToFloat(b.xyz), b.w);
}

/// The nearest cut node that faces the same way, within sqrt(radius2); kNone where there is none.
uint nearestCutNode(vec3 x, vec3 n, float radius2)
{
    uint nearest = kNone;
    uint first, end;
    beginRanges(cut_size.count);
    while (nextRange(x, radius2, first, end))
        for (uint i = first; i < end; ++i)
        {
            vec3 normal = unpackNormal(loadCutNode(i).normal);
            float distance2 = surfaceDistance2(loadCutNode(i).center - x, normal);
            if (distance2 < radius2 && dot(n, normal) > 0.2)
            {
                radius2 = distance2;
                nearest = i;
            }
        }
    return nearest;
}

/// Its irradiance; 0 where there is none.
vec3 nearestCutIrradiance(vec3 x, vec3 n, float radius2)
{
    uint nearest = nearestCutNode(x, n, radius2);
    if (nearest == kNone)
        return vec3(0.0);
    return loadCutNode(nearest).irradiance;
}

/// Irradiance at x: the sum of what the cut nodes around it spread there. 0 where no photon fell near: what light there is
/// has gone to the places where photons fell.
vec3 cutIrradiance(vec3 x, vec3 n)
{
    vec3 sum = vec3(0.0);
    uint first, end;
    beginRanges(cut_size.count);
    while (nextRange(x, 0.0, first, end))
        for (uint i = first; i < end; ++i)
        {
            CutNode node = loadCutNode(i);
            sum += cutWeight(node, x, n) * node.irradiance;
        }
    return sum;
}

#endif
