// Reading the light of the illumination cut. The kernel declares what lib/cut.glsl wants and `buffer Directions
// { uint directions[]; }` before it includes this. Functions only.
#ifndef LIB_CUT_LIGHT_GLSL
#define LIB_CUT_LIGHT_GLSL
#include "shaders/lib/cut.glsl"
#include "shaders/lib/incident.glsl"
#include "shaders/lib/random.glsl"
#include "shaders/lib/trace.glsl"

/// The light of the nearest cut node that faces the same way, within sqrt(radius2); none where there is none.
Incident nearestCutLight(vec3 x, vec3 n, float radius2)
{
    uint nearest = nearestCutNode(x, n, radius2);
    if (nearest == kNone)
        return Incident(vec3(0.0), -n, vec3(0.0));
    vec3 irradiance = loadCutNode(nearest).irradiance;
    return Incident(irradiance, unpackNormal(directions[nearest]), irradiance);
}

// What lies so far behind a node's disc, in supports, or faces so far away from where it does, may be hidden by the disc's own surface:
// where a sheet meets a floor at 45 degrees, sunlight on the one side shone along the edge on the other (a room 2 % too bright).
const float kBehindDisc = 0.02, kFacingDisc = 0.95;

/// Whether the node is surely visible from the surface at x: from everywhere on its disc, of which that is a part.
bool isSurelySeen(CutNode node, vec3 x, vec3 n)
{
    vec3 normal = cutNormal(node);
    bool on_disc = dot(x - node.center, normal) >= -kBehindDisc * node.support && dot(n, normal) >= kFacingDisc;
    return (isClear(node) && on_disc) || eyeHeight(node) == 0.0;
}

/// Whether the node's eye is visible from the surface at x. Translucent surfaces stop the ray as they stop the probe rays.
bool isSeen(CutNode node, vec3 x, vec3 n, uint random)
{
    if (isSurelySeen(node, x, n))
        return true;
    float height = eyeHeight(node);
    vec3 origin = offsetOrigin(x, n);
    vec3 d = node.center + height * cutNormal(node) - origin;
    float distance = length(d);
    vec3 direction = d / max(distance, 1e-30);
    bool met_translucent;
    if (meetsOpaque(origin, direction, distance, met_translucent))
        return false;
    return !kSceneHasTranslucency || !met_translucent || closestHit(origin, direction, kRayStart, distance, random).slot == kNone;
}

/// Light at x: the sum of what the visible cut nodes around it spread there. One node is chosen with probability proportional to
/// its irradiance at x; it gives the direction of the light, and one ray tests its visibility, so that the expectation is the sum
/// over visible nodes. The result has the chosen node's color: the color of the sum would include nodes behind walls. None if no
/// photon fell near: its power is where photons fell. @param random bits
Incident cutLight(vec3 x, vec3 n, uint random)
{
    vec3 sum = vec3(0.0);
    Reservoir reservoir = Reservoir(random, 0.0, kNone);
    bool is_sure = true; // all are seen
    uint i, end;
    beginRanges(cut_size.count);
    for (;;)
    {
        if (nextRange(x, 0.0, i, end))
            for (;;)
            {
                if (isWithinSupport(i, x))
                {
                    CutNode node = loadCutNode(i);
                    vec3 irradiance = cutWeight(node, x, n) * node.irradiance;
                    sum += irradiance;
                    is_sure = is_sure && (irradiance == vec3(0.0) || isSurelySeen(node, x, n));
                    offer(reservoir, luminance(irradiance), i);
                }
                if (++i == end)
                    break;
            }
        if (!hasRanges())
            break;
    }
    uint chosen = reservoir.chosen;
    if (chosen == kNone || !isSeen(loadCutNode(chosen), x, n, random))
        return Incident(vec3(0.0), -n, vec3(0.0));
    vec3 color = loadCutNode(chosen).irradiance, in_its_color = color * (reservoir.sum / max(luminance(color), 1e-30));
    return Incident(is_sure ? sum : in_its_color, unpackNormal(directions[chosen]), in_its_color);
}

#endif
