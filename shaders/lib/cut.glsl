// Reading the illumination cut. The kernel declares `buffer CutSize { QueueSize cut_size; }`, `buffer TreeNodes` (of the cut)
// and `buffer CutNodes { CutNode cut_nodes[]; }` before it includes this. Functions only.
#ifndef LIB_CUT_GLSL
#define LIB_CUT_GLSL
#include "shaders/cut/cut.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/tree.glsl"

/// Irradiance of the nearest cut node that faces the same way, within sqrt(radius2); 0 where there is none.
vec3 nearestCutIrradiance(vec3 x, vec3 n, float radius2)
{
    uint nearest = kNone;
    uint first, end;
    beginRanges(cut_size.count);
    while (nextRange(x, radius2, first, end))
        for (uint i = first; i < end; ++i)
        {
            vec3 d = cut_nodes[i].center - x;
            if (dot(d, d) < radius2 && dot(n, unpackNormal(cut_nodes[i].normal)) > 0.2)
            {
                radius2 = dot(d, d);
                nearest = i;
            }
        }
    if (nearest == kNone)
        return vec3(0.0);
    return cut_nodes[nearest].irradiance;
}

/// Irradiance at x from the cut nodes whose support holds it, weighted by distance and normal; from the nearest one
/// otherwise. @param radius2 square metres: how far that may be
/// @param support metres, mean support of the nodes that were read
vec3 cutIrradiance(vec3 x, vec3 n, float radius2, out float support)
{
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    support = 0.0;
    uint first, end;
    beginRanges(cut_size.count);
    while (nextRange(x, 0.0, first, end))
        for (uint i = first; i < end; ++i)
        {
            CutNode node = cut_nodes[i];
            vec3 d = node.center - x;
            float weight = max(0.0, 1.0 - dot(d, d) / square(node.support)) * max(0.0, dot(n, unpackNormal(node.normal)));
            sum += weight * node.irradiance;
            support += weight * node.support;
            weights += weight;
        }
    if (weights < 1e-3)
        return nearestCutIrradiance(x, n, radius2);
    support /= weights;
    return sum / weights;
}

#endif
