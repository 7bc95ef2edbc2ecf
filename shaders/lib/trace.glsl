// Rays through a scene with translucent surfaces: alpha coverage and thin-walled transmission. Functions only.
#ifndef LIB_TRACE_GLSL
#define LIB_TRACE_GLSL
#include "shaders/lib/bsdf.glsl"
#include "shaders/lib/bvh.glsl"
#include "shaders/lib/coverage.glsl"
#include "shaders/lib/random.glsl"
#include "shaders/lib/surface.glsl"

// Texture lookups in the loop over a leaf's triangles would cost every ray registers, and software Vulkan, which runs both
// sides of every branch, most of its speed. So that loop only notes that a leaf has something to decide, and leaves it to
// a second one around it, which threads enter together. Neither starts again from the root: rays cross any number of layers.
// (Software Vulkan ends all loops of a thread after 65535 rounds together: some thousand layers are within that.)

struct AlphaSeed
{
    uint seed;
    ivec2 pixel; // of a camera ray, whose seed is that of all pixels; else 0
};

/// Thresholds of neighbouring pixels: any few of them are spread evenly (R2 sequence, Roberts 2018). @param variant one of 8
float dithered(ivec2 pixel, uint variant)
{
    vec2 at = vec2((variant & 1u) != 0u ? pixel.yx : pixel);
    at *= vec2((variant & 2u) != 0u ? -1.0 : 1.0, (variant & 4u) != 0u ? -1.0 : 1.0);
    return fract(dot(at, vec2(0.7548776662, 0.5698402910)));
}

/// Whether the ray meets a surface with alpha: by the probability of its coverage, one decision a triangle, whatever the
/// order of the tests. Of camera rays as many of a few neighbours meet it as its coverage says, where chance alone would give each
/// frame of a curtain grains. Layers have patterns of their own: a ray meets one whether or not it met the other.
bool meetsAlpha(Hit hit, uint triangle, AlphaSeed seed)
{
    uint random = hash(seed.seed, triangle);
    return fract(toUnitFloat(random) + dithered(seed.pixel, random)) < surfaceCoverage(hit.slot, hit.barycentrics);
}

/// The nearest of those triangles with alpha that the ray meets, if it is nearer than `hit`.
/// @param slots of a leaf, a bit each from slot `first` on
void hitAlphaTriangles(uint first, uint slots, TriangleRay ray, Place start, inout Place end, inout Hit hit, AlphaSeed seed)
{
    for (;;)
    {
        uint slot = first + findLSB(slots);
        Place place = end;
        Hit candidate = hit;
        if (hitTriangle(slot, ray, start, place, candidate) && meetsAlpha(candidate, loadBvhTriangle(slot).triangle, seed))
        {
            hit = candidate;
            end = place;
        }
        slots &= slots - 1u;
        if (slots == 0u)
            break;
    }
}

/// The nearest surface behind `start` and before t_max; one with alpha is there with the probability of its coverage, decided
/// by `seed`.
Hit closestHit(vec3 origin, vec3 direction, Place start, float t_max, AlphaSeed seed)
{
    traversal_depth = 0u;
    uint current = 0u;
    Hit hit = Hit(t_max, kNone, vec2(0.0));
    Place end = Place(t_max, 0u);
    BoxRay ray = boxRay(origin, direction);
    TriangleRay triangle_ray = triangleRay(origin, direction);
    for (;;)
    {
        // Down to a leaf; then its triangles: two loops, so that neighbouring rays do the same kind of work together
        // (Aila & Laine 2009, "Understanding the Efficiency of Ray Traversal on GPUs").
        uint first, undecided = 0u; // slots, a bit each
        for (;;)
        {
            current = nearestLeaf(current, ray, start.t, end.t);
            if (current != kNone)
            {
                first = current & kLeafFirstMask;
                uint slot = first, last = leafEnd(current) - 1u;
                for (;;)
                {
                    Place place = end;
                    Hit candidate = hit;
                    if (hitTriangle(slot, triangle_ray, start, place, candidate))
                    {
                        if (kSceneHasAlpha && (loadBvhTriangle(slot).flags & kTriangleAlpha) != 0u)
                            undecided |= 1u << (slot - first);
                        else
                        {
                            hit = candidate;
                            end = place;
                        }
                    }
                    if (slot++ == last)
                        break;
                }
                if (!kSceneHasAlpha || undecided == 0u)
                    current = popNearer(end.t);
            }
            if (current == kNone || (kSceneHasAlpha && undecided != 0u))
                break;
        }
        if (kSceneHasAlpha && undecided != 0u)
        {
            hitAlphaTriangles(first, undecided, triangle_ray, start, end, hit, seed);
            current = popNearer(end.t);
        }
        if (!kSceneHasAlpha || current == kNone)
            break;
    }
    return hit;
}

Hit closestHit(vec3 origin, vec3 direction, Place start, float t_max, uint seed)
{
    return closestHit(origin, direction, start, t_max, AlphaSeed(seed, ivec2(0)));
}

/// What a thin wall lets straight through where it is; 0 for any other surface.
vec3 thinTransmittance(Hit hit, vec3 direction)
{
    if (!kSceneHasThin || (loadBvhTriangle(hit.slot).flags & kTriangleThin) == 0u)
        return vec3(0.0);
    Surface s = surfaceAt(hit.slot, hit.barycentrics, direction);
    Bsdf b = bsdfAt(materialAt(s), s.front, vec3(0.0, 0.0, 1.0));
    float cosine = -dot(s.normal, direction);
    vec3 wo = vec3(sqrt(max(0.0, 1.0 - cosine * cosine)), 0.0, cosine);
    return covered(b, wo, wo) * belowColor(b, cosine) * b.transmission;
}

/// What a translucent surface lets straight through: what it does not cover, and thin smooth transmission of the rest.
vec3 layerTransmittance(Hit hit, vec3 direction)
{
    bool alpha = (loadBvhTriangle(hit.slot).flags & kTriangleAlpha) != 0u;
    float coverage = alpha ? surfaceCoverage(hit.slot, hit.barycentrics) : 1.0;
    return 1.0 - coverage * (1.0 - thinTransmittance(hit, direction));
}

/// Whether a ray ends in the triangle's plane up to rounding: the surface on which a light lies does not shadow it.
bool endsOn(uint slot, vec3 origin, vec3 direction, float t_max)
{
    vec3 v0 = loadBvhTriangle(slot).v0, v1 = loadBvhTriangle(slot).v1, v2 = loadBvhTriangle(slot).v2;
    vec3 normal = cross(v1 - v0, v2 - v0);
    float off = dot(normal, v0 - origin) - t_max * dot(normal, direction);
    return abs(off) <= planeError(v0, v1, v2, abs(origin) + t_max * abs(direction)) * length(normal);
}

/// Whether slot's triangle is in the way of a ray to t_max.
bool isBetween(uint slot, TriangleRay ray, float t_max, out Hit hit)
{
    Place end = Place(t_max, 0u);
    return hitTriangle(slot, ray, kRayStart, end, hit) && (hit.t < 0.5 * t_max || !endsOn(slot, ray.origin, ray.direction, t_max));
}

/// Whether an opaque triangle lies within t_max. Translucent ones (any kTriangle* flag) let the ray pass;
/// `met_translucent` is whether there was one, so that the caller need not search for them otherwise.
bool meetsOpaque(vec3 origin, vec3 direction, float t_max, out bool met_translucent)
{
    traversal_depth = 0u;
    uint current = 0u;
    BoxRay ray = boxRay(origin, direction);
    TriangleRay triangle_ray = triangleRay(origin, direction);
    met_translucent = false;
    bool met = false;
    for (;;)
    {
        current = anyLeaf(current, ray, t_max);
        if (current != kNone)
        {
            uint slot = current & kLeafFirstMask, last = leafEnd(current) - 1u;
            for (;;)
            {
                Hit hit;
                if (isBetween(slot, triangle_ray, t_max, hit))
                {
                    if (kSceneHasTranslucency && loadBvhTriangle(slot).flags != 0u)
                        met_translucent = true;
                    else
                        met = true;
                }
                if (met || slot++ == last)
                    break;
            }
            current = met ? kNone : popAny();
        }
        if (current == kNone)
            break;
    }
    return met;
}

/// What all translucent triangles within t_max let through together: each is stored once, so in any order.
vec3 translucentTransmittance(vec3 origin, vec3 direction, float t_max)
{
    traversal_depth = 0u;
    uint current = 0u;
    BoxRay ray = boxRay(origin, direction);
    TriangleRay triangle_ray = triangleRay(origin, direction);
    vec3 through = vec3(1.0);
    for (;;)
    {
        uint first, met = 0u; // slots, a bit each
        for (;;)
        {
            current = anyLeaf(current, ray, t_max);
            if (current != kNone)
            {
                first = current & kLeafFirstMask;
                uint slot = first, last = leafEnd(current) - 1u;
                for (;;)
                {
                    Place end = Place(t_max, 0u);
                    Hit hit;
                    if (loadBvhTriangle(slot).flags != 0u && hitTriangle(slot, triangle_ray, kRayStart, end, hit))
                        met |= 1u << (slot - first);
                    if (slot++ == last)
                        break;
                }
                if (met == 0u)
                    current = popAny();
            }
            if (current == kNone || met != 0u)
                break;
        }
        if (current != kNone)
        {
            for (;;)
            {
                uint slot = first + findLSB(met);
                Hit hit;
                if (isBetween(slot, triangle_ray, t_max, hit))
                {
                    vec3 layer = layerTransmittance(hit, direction);
                    if (layer == vec3(0.0) || ownsEdge(slot, triangle_ray)) // two halves of a pane are one pane along their edge
                        through *= layer;
                }
                met &= met - 1u;
                if (met == 0u)
                    break;
            }
            current = through == vec3(0.0) ? kNone : popAny();
        }
        if (current == kNone)
            break;
    }
    return through;
}

/// Fraction of light that gets from origin to origin + t_max direction.
vec3 transmittance(vec3 origin, vec3 direction, float t_max)
{
    bool met_translucent;
    if (meetsOpaque(origin, direction, t_max, met_translucent))
        return vec3(0.0);
    if (!kSceneHasTranslucency || !met_translucent)
        return vec3(1.0);
    return translucentTransmittance(origin, direction, t_max);
}

#endif
