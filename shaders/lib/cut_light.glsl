// Reading the light of the illumination cut. The kernel declares what lib/cut.glsl wants and `buffer Directions
// { uint directions[]; }` before it includes this. Functions only.
#ifndef LIB_CUT_LIGHT_GLSL
#define LIB_CUT_LIGHT_GLSL
#include "shaders/lib/cut.glsl"
#include "shaders/lib/incident.glsl"
#include "shaders/lib/random.glsl"

/// The light of the nearest cut node that faces the same way, within sqrt(radius2); none where there is none.
Incident nearestCutLight(vec3 x, vec3 n, float radius2)
{
    uint nearest = nearestCutNode(x, n, radius2);
    if (nearest == kNone)
        return Incident(vec3(0.0), -n, vec3(0.0));
    vec3 irradiance = loadCutNode(nearest).irradiance;
    return Incident(irradiance, unpackNormal(directions[nearest]), irradiance);
}

/// Light at x: the sum of what the cut nodes around it spread there. None where no photon fell near: what light there is
/// has gone to the places where photons fell. @param random bits
Incident cutLight(vec3 x, vec3 n, uint random)
{
    vec3 sum = vec3(0.0);
    Reservoir speaker = Reservoir(random, 0.0, kNone);
    uint first, end;
    beginRanges(cut_size.count);
    while (nextRange(x, 0.0, first, end))
        for (uint i = first; i < end; ++i)
        {
            CutNode node = loadCutNode(i);
            vec3 irradiance = cutWeight(node, x, n) * node.irradiance;
            sum += irradiance;
            offer(speaker, luminance(irradiance), i);
        }
    if (speaker.chosen == kNone)
        return Incident(sum, -n, sum);
    vec3 color = loadCutNode(speaker.chosen).irradiance;
    return Incident(sum, unpackNormal(directions[speaker.chosen]), color * (speaker.sum / max(luminance(color), 1e-30)));
}

#endif
