// Reading the illumination cut. The kernel declares `buffer CutSize { QueueSize cut_size; }` and the usamplerBuffers
// TreeNodes (of the cut) and CutNodes before it includes this. Functions only.
#ifndef LIB_CUT_GLSL
#define LIB_CUT_GLSL
#include "shaders/cut/cut.h"
#include "shaders/lib/math.glsl"
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

// Where nodes cover a surface evenly their weights sum to more than 1 (pi / 2 for a lattice). Below this the place lies at
// the rim of what the photons lit, and the light fades: nodes exist where photons fell, so nothing else would say that
// there are none here.
const float kFullCover = 0.5;

/// Irradiance at x from the cut nodes whose support holds it, weighted by distance and normal; 0 where no photon fell near.
vec3 cutIrradiance(vec3 x, vec3 n)
{
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    uint first, end;
    beginRanges(cut_size.count);
    while (nextRange(x, 0.0, first, end))
        for (uint i = first; i < end; ++i)
        {
            CutNode node = loadCutNode(i);
            vec3 normal = unpackNormal(node.normal);
            float distance2 = surfaceDistance2(node.center - x, normal);
            float weight = max(0.0, 1.0 - distance2 / square(node.support)) * max(0.0, dot(n, normal));
            sum += weight * node.irradiance;
            weights += weight;
        }
    return sum / max(weights, kFullCover);
}

#endif
