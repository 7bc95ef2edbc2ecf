// Shadow rays through thin-walled smooth transmission: straight on, tinted. Functions only.
#ifndef LIB_THIN_GLSL
#define LIB_THIN_GLSL
#include "shaders/lib/bsdf.glsl"
#include "shaders/lib/bvh.glsl"
#include "shaders/lib/surface.glsl"

const uint kMaxThinWalls = 16u; // along one shadow ray; more count as opaque

/// Fraction of light that gets from origin to origin + t_max direction.
vec3 transmittance(vec3 origin, vec3 direction, float t_max, uint seed)
{
    if (anyHit(origin, direction, t_max, seed))
        return vec3(0.0);
    vec3 through = vec3(1.0);
    if (!kSceneHasThin)
        return through;
    for (uint wall = 0u; wall < kMaxThinWalls; ++wall)
    {
        Hit hit = closestHit(origin, direction, t_max, seed);
        if (hit.slot == kNone)
            return through;
        Surface s = surfaceAt(hit.slot, hit.barycentrics, direction);
        Bsdf b = bsdfAt(materialAt(s), s.front);
        through *= belowColor(b, -dot(s.normal, direction)) * b.transmission;
        origin = offsetOrigin(s.position, -s.geometric_normal);
        t_max -= hit.t;
    }
    return vec3(0.0);
}

#endif
