// Finding nodes of the illumination cut. The kernel declares `buffer CutSize { QueueSize cut_size; }` and the usamplerBuffers
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

/// Whether x is within a node's support: half of what is near is not, and costs one texel.
bool isWithinSupport(uint index, vec3 x)
{
    vec4 sphere = uintBitsToFloat(texelFetch(CutNodes, int(2u * index)));
    vec3 d = x - sphere.xyz;
    return dot(d, d) < square(sphere.w);
}

/// The nearest cut node that faces the same way, within sqrt(radius2); kNone where there is none.
uint nearestCutNode(vec3 x, vec3 n, float radius2)
{
    uint nearest = kNone;
    uint i, end;
    beginRanges(cut_size.count);
    for (;;)
    {
        if (nextRange(x, radius2, i, end))
            for (;;)
            {
                vec3 normal = cutNormal(loadCutNode(i));
                float distance2 = surfaceDistance2(loadCutNode(i).center - x, normal);
                if (distance2 < radius2 && dot(n, normal) > 0.2)
                {
                    radius2 = distance2;
                    nearest = i;
                }
                if (++i == end)
                    break;
            }
        if (!hasRanges())
            break;
    }
    return nearest;
}

#endif
