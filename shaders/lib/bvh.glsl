// Ray traversal of the 4-wide tree: the one closest-hit and the one any-hit routine, geometry only. What translucent
// surfaces do to a ray is decided outside these loops (lib/trace.glsl): texture lookups inside them would cost every ray
// registers, and software Vulkan, which runs both sides of every branch, most of its speed. Functions only.
#ifndef LIB_BVH_GLSL
#define LIB_BVH_GLSL
#include "shaders/lib/math.glsl"
#include "shaders/lib/scene.glsl"
#include "shaders/rays/rays.h"

/// 1 / direction without infinities: 0 * inf = NaN would lose boxes that a ray grazes.
vec3 safeInverse(vec3 direction)
{
    vec3 tiny = mix(vec3(1e-20), vec3(-1e-20), lessThan(direction, vec3(0.0)));
    return 1.0 / mix(direction, tiny, lessThan(abs(direction), vec3(1e-20)));
}

/// Entry distances of a ray into a node's four boxes; larger than t_max where it misses.
vec4 hitBoxes(uint node, vec3 origin, vec3 inverse, float t_max)
{
    vec4 x0 = (bvh_nodes[node].min_x - origin.x) * inverse.x, x1 = (bvh_nodes[node].max_x - origin.x) * inverse.x;
    vec4 y0 = (bvh_nodes[node].min_y - origin.y) * inverse.y, y1 = (bvh_nodes[node].max_y - origin.y) * inverse.y;
    vec4 z0 = (bvh_nodes[node].min_z - origin.z) * inverse.z, z1 = (bvh_nodes[node].max_z - origin.z) * inverse.z;
    vec4 enter = max(max(min(x0, x1), min(y0, y1)), max(min(z0, z1), vec4(0.0)));
    vec4 leave = min(min(max(x0, x1), max(y0, y1)), min(max(z0, z1), vec4(t_max)));
    // Three roundings on each side: Ize 2013, "Robust BVH Ray Traversal".
    return mix(vec4(kInfinity), enter, lessThanEqual(enter, leave * 1.0000004));
}

/// Watertight along shared edges: the edge functions of two neighbours are exact negatives of each other
/// (Davidovic et al. 2012, "3D Rasterization", in the sum-and-difference form, which FMA contraction cannot break).
/// @return whether it is met between t_min (exclusive) and hit.t, which then is it
bool hitTriangle(uint slot, vec3 origin, vec3 direction, float t_min, inout Hit hit)
{
    vec3 a = bvh_triangles[slot].v0 - origin;
    vec3 b = bvh_triangles[slot].v1 - origin;
    vec3 c = bvh_triangles[slot].v2 - origin;
    vec3 e0 = c - a, e1 = a - b, e2 = b - c;
    float u = dot(cross(c + a, e0), direction); // weight of v1
    float v = dot(cross(a + b, e1), direction); // weight of v2
    float w = dot(cross(b + c, e2), direction); // weight of v0
    if (min(u, min(v, w)) < 0.0 && max(u, max(v, w)) > 0.0)
        return false;
    vec3 normal = cross(e1, e0);
    float along = dot(normal, direction);
    float t = dot(normal, a) / along;
    if (!(t > t_min && t < hit.t)) // also refuses NaN: a ray in the triangle's plane
        return false;
    float sum = u + v + w;
    vec2 barycentrics = sum == 0.0 ? vec2(0.0) : vec2(u, v) / sum;
    hit = Hit(t, slot, barycentrics);
    return true;
}

void swapIfFarther(inout float t0, inout uint c0, inout float t1, inout uint c1)
{
    bool swap = t1 < t0;
    float t = swap ? t1 : t0;
    uint c = swap ? c1 : c0;
    t1 = swap ? t0 : t1;
    c1 = swap ? c0 : c1;
    t0 = t;
    c0 = c;
}

uint leafEnd(uint child) { return (child & kLeafFirstMask) + ((child >> kLeafCountShift) & kLeafCountMask) + 1u; }

/// The nearest triangle between t_min (exclusive) and t_max, whatever its coverage.
Hit nearestTriangle(vec3 origin, vec3 direction, float t_min, float t_max)
{
    uint stack[kTraversalStackSize];
    uint depth = 0u;
    uint current = 0u;
    Hit hit = Hit(t_max, kNone, vec2(0.0));
    vec3 inverse = safeInverse(direction);
    while (true)
    {
        // Down to a leaf; then its triangles: two loops, so that neighbouring rays do the same kind of work together
        // (Aila & Laine 2009, "Understanding the Efficiency of Ray Traversal on GPUs").
        while ((current & kLeafBit) == 0u)
        {
            vec4 t = hitBoxes(current, origin, inverse, hit.t);
            uvec4 child = bvh_nodes[current].child;
            t = mix(t, vec4(kInfinity), equal(child, uvec4(kNone)));
            swapIfFarther(t.x, child.x, t.y, child.y);
            swapIfFarther(t.z, child.z, t.w, child.w);
            swapIfFarther(t.x, child.x, t.z, child.z);
            swapIfFarther(t.y, child.y, t.w, child.w);
            swapIfFarther(t.y, child.y, t.z, child.z);
            if (t.w < kInfinity)
                stack[depth++] = child.w;
            if (t.z < kInfinity)
                stack[depth++] = child.z;
            if (t.y < kInfinity)
                stack[depth++] = child.y;
            current = t.x < kInfinity ? child.x : depth > 0u ? stack[--depth] : kNone;
        }
        if (current == kNone)
            return hit;
        for (uint slot = current & kLeafFirstMask; slot < leafEnd(current); ++slot)
            hitTriangle(slot, origin, direction, t_min, hit);
        current = depth > 0u ? stack[--depth] : kNone;
    }
}

/// Whether an opaque triangle lies within t_max. Translucent ones (any kTriangle* flag) let the ray pass;
/// `met_translucent` says whether there was one, so that the caller knows when nothing is left to look at.
bool anyOpaqueTriangle(vec3 origin, vec3 direction, float t_max, out bool met_translucent)
{
    uint stack[kTraversalStackSize];
    uint depth = 0u;
    uint current = 0u;
    vec3 inverse = safeInverse(direction);
    met_translucent = false;
    while (true)
    {
        while ((current & kLeafBit) == 0u)
        {
            vec4 t = hitBoxes(current, origin, inverse, t_max);
            uvec4 child = bvh_nodes[current].child;
            uint next = kNone;
            for (uint i = 0u; i < kBvhWidth; ++i)
                if (t[i] < kInfinity && child[i] != kNone)
                {
                    if (next != kNone)
                        stack[depth++] = next;
                    next = child[i];
                }
            current = next != kNone ? next : depth > 0u ? stack[--depth] : kNone;
        }
        if (current == kNone)
            return false;
        for (uint slot = current & kLeafFirstMask; slot < leafEnd(current); ++slot)
        {
            Hit hit = Hit(t_max, kNone, vec2(0.0));
            if (!hitTriangle(slot, origin, direction, 0.0, hit))
                continue;
            if (!kSceneHasTranslucency || bvh_triangles[slot].flags == 0u)
                return true;
            met_translucent = true;
        }
        current = depth > 0u ? stack[--depth] : kNone;
    }
}

#endif
