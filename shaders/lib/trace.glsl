// Rays through a scene with translucent surfaces: alpha coverage and thin-walled transmission. Functions only.
#ifndef LIB_TRACE_GLSL
#define LIB_TRACE_GLSL
#include "shaders/lib/bsdf.glsl"
#include "shaders/lib/bvh.glsl"
#include "shaders/lib/coverage.glsl"
#include "shaders/lib/random.glsl"
#include "shaders/lib/surface.glsl"

const uint kMaxLayers = 64u; // translucent surfaces along one ray; the next one counts as opaque

/// The nearest surface between t_min (exclusive) and t_max; one with alpha is there with the probability of its coverage,
/// decided by `seed`.
Hit closestHit(vec3 origin, vec3 direction, float t_min, float t_max, uint seed)
{
    Hit hit;
    float t = t_min;
    for (uint layer = 0u; layer < kMaxLayers; ++layer)
    {
        hit = nearestTriangle(origin, direction, t, t_max);
        if (!kSceneHasAlpha || hit.slot == kNone || (loadBvhTriangle(hit.slot).flags & kTriangleAlpha) == 0u)
            break;
        if (toUnitFloat(hash(seed, layer)) < surfaceCoverage(hit.slot, hit.barycentrics))
            break;
        t = hit.t;
    }
    return hit;
}

/// What a thin wall lets straight through where it is; 0 for any other surface.
vec3 thinTransmittance(Hit hit, vec3 direction)
{
    if (!kSceneHasThin || (loadBvhTriangle(hit.slot).flags & kTriangleThin) == 0u)
        return vec3(0.0);
    Surface s = surfaceAt(hit.slot, hit.barycentrics, direction);
    Bsdf b = bsdfAt(materialAt(s), s.front);
    return belowColor(b, -dot(s.normal, direction)) * b.transmission;
}

/// What a translucent surface lets straight through: what it does not cover, and thin smooth transmission of the rest.
vec3 layerTransmittance(Hit hit, vec3 direction)
{
    bool alpha = (loadBvhTriangle(hit.slot).flags & kTriangleAlpha) != 0u;
    float coverage = alpha ? surfaceCoverage(hit.slot, hit.barycentrics) : 1.0;
    return 1.0 - coverage * (1.0 - thinTransmittance(hit, direction));
}

/// Fraction of light that gets from origin to origin + t_max direction.
vec3 transmittance(vec3 origin, vec3 direction, float t_max)
{
    bool met_translucent;
    if (anyOpaqueTriangle(origin, direction, t_max, met_translucent))
        return vec3(0.0);
    vec3 through = vec3(1.0);
    if (!kSceneHasTranslucency || !met_translucent)
        return through;
    float t = 0.0;
    for (uint layer = 0u; layer < kMaxLayers; ++layer)
    {
        Hit hit = nearestTriangle(origin, direction, t, t_max);
        if (hit.slot == kNone || through == vec3(0.0))
            return through;
        through *= layerTransmittance(hit, direction);
        t = hit.t;
    }
    return vec3(0.0);
}

#endif
