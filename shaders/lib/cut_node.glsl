// What one node of the illumination cut lights. Functions only.
#ifndef LIB_CUT_NODE_GLSL
#define LIB_CUT_NODE_GLSL
#include "shaders/cut/cut.h"
#include "shaders/lib/math.glsl"

uint packCutNormal(vec3 normal, float height, float support)
{
    const float kMost = float((1u << (kCutNormalBits - 1u)) - 1u);
    ivec2 e = ivec2(round(unitToOctahedral(normal) * kMost));
    uint eye = height > 0.0 ? uint(clamp(round(height / (kProbeHeight * support) * float(kCutEyeSteps)), 1.0, float(kCutEyeSteps))) : 0u;
    const uint kMask = (1u << kCutNormalBits) - 1u;
    return (uint(e.x) & kMask) | (uint(e.y) & kMask) << kCutNormalBits | eye << 2u * kCutNormalBits;
}

vec3 cutNormal(CutNode node)
{
    const float kMost = float((1u << (kCutNormalBits - 1u)) - 1u);
    int bits = int(node.normal_and_eye), size = int(kCutNormalBits);
    return octahedralToUnit(vec2(bitfieldExtract(bits, 0, size), bitfieldExtract(bits, size, size)) / kMost);
}

/// Metres above its centre: the eye, from which its disc is seen; 0: from infinitely far.
float eyeHeight(CutNode node)
{
    return float(bitfieldExtract(node.normal_and_eye, 2 * int(kCutNormalBits), 7)) * (kProbeHeight / float(kCutEyeSteps)) * node.support;
}

bool isClear(CutNode node) { return (node.normal_and_eye & kCutIsClear) != 0u; }

/// Weight of a node at a surface point x with normal n: 1 at its centre, 0 from its support on and on other surfaces. What lies
/// off the node's plane counts as the place of the plane that it hides from the eye, and less: rays from the eye to the disc then
/// meet all that has any weight, each piece of it once (cut/probe.comp).
float cutWeight(CutNode node, vec3 x, vec3 n)
{
    vec3 normal = cutNormal(node), d = x - node.center;
    float along = dot(d, normal), distance2 = dot(d, d), support2 = square(node.support), height = eyeHeight(node);
    if (distance2 >= support2 || dot(n, normal) <= 0.2 || (height > 0.0 && along >= 0.9 * height))
        return 0.0;
    float across2 = max(distance2 - along * along, 0.0) * (height > 0.0 ? square(height / (height - along)) : 1.0);
    return max(0.0, 1.0 - (across2 + 16.0 * along * along) / support2);
}

/// Integral of that weight over a plane through the node, square metres.
float cutArea(float support) { return 0.5 * kPi * square(support); }

/// Coverage probe rays of each node: the number set, or fewer if there are too many nodes; in both parts alike.
ProbeParams probesFor(uint node_count, ProbeParams wanted)
{
    uint room = kCutProbeCapacity / max(node_count, 1u), all = wanted.ray_count + wanted.rim_count;
    if (all <= room)
        return wanted;
    uint ray_count = wanted.ray_count * room / all;
    return ProbeParams(ray_count, room - ray_count, wanted.seed);
}

#endif
