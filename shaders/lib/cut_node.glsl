// What one node of the illumination cut lights. Functions only.
#ifndef LIB_CUT_NODE_GLSL
#define LIB_CUT_NODE_GLSL
#include "shaders/cut/cut.h"
#include "shaders/lib/math.glsl"

/// Weight of a node at a surface point x with normal n: 1 at its centre, 0 from its support on and on other surfaces.
float cutWeight(CutNode node, vec3 x, vec3 n)
{
    vec3 normal = unpackNormal(node.normal);
    float distance2 = surfaceDistance2(node.center - x, normal);
    return dot(n, normal) > 0.2 ? max(0.0, 1.0 - distance2 / square(node.support)) : 0.0;
}

/// Integral of that weight over a plane through the node, square metres.
float cutArea(float support) { return 0.5 * kPi * square(support); }

/// Rays each node feels for its surface with: those wanted, or fewer where there are too many nodes.
uint probeCount(uint node_count, uint wanted) { return min(wanted, kCutProbeCapacity / max(node_count, 1u)); }

#endif
