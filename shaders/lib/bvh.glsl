// Ray traversal of the 4-wide tree, down to its leaves, and the triangle test. The loops over leaves, which know what
// translucent surfaces do to a ray, are in lib/trace.glsl. Functions only.
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

/// What the box test needs of a ray, computed once.
struct BoxRay
{
    vec3 inverse;
    vec3 near_shift, far_shift; // origin x inverse, moved apart by the rounding error of the test
    uvec3 near_row;             // row of a node's near planes per axis; the far planes' is the other of the pair
};

BoxRay boxRay(vec3 origin, vec3 direction)
{
    BoxRay ray;
    ray.inverse = safeInverse(direction);
    vec3 shift = origin * ray.inverse;
    vec3 slack = abs(shift) * 4e-7;
    ray.near_shift = shift + slack;
    ray.far_shift = shift - slack;
    ray.near_row = uvec3(0u, 2u, 4u) + uvec3(lessThan(ray.inverse, vec3(0.0)));
    return ray;
}

vec4 nodeRow(uint row) { return uintBitsToFloat(texelFetch(bvh_nodes, int(row))); }

/// Entry distances of a ray into a node's four boxes; kInfinity where it misses them between t_min and t_max.
vec4 hitBoxes(uint node, BoxRay ray, float t_min, float t_max)
{
    uint row = node * kBvhNodeRows;
    uvec3 near = row + ray.near_row, far = row + (ray.near_row ^ 1u);
    vec4 enter = max(max(nodeRow(near.x) * ray.inverse.x - ray.near_shift.x, nodeRow(near.y) * ray.inverse.y - ray.near_shift.y),
                     max(nodeRow(near.z) * ray.inverse.z - ray.near_shift.z, vec4(t_min)));
    vec4 leave = min(min(nodeRow(far.x) * ray.inverse.x - ray.far_shift.x, nodeRow(far.y) * ray.inverse.y - ray.far_shift.y),
                     min(nodeRow(far.z) * ray.inverse.z - ray.far_shift.z, vec4(t_max)));
    return mix(vec4(kInfinity), enter, lessThanEqual(enter, leave));
}

uvec4 nodeChildren(uint node) { return texelFetch(bvh_nodes, int(node * kBvhNodeRows + 6u)); }

/// What the triangle test needs of a ray: it looks at triangles along the ray, projected to the plane across it.
struct TriangleRay
{
    vec3 origin, direction;
    vec3 x, y; // with direction a frame
};

TriangleRay triangleRay(vec3 origin, vec3 direction)
{
    mat3 frame = frameAround(direction);
    return TriangleRay(origin, direction, frame[0], frame[1]);
}

/// One place of a ray's way: triangles are met in the order of distance, and of rank where that is equal. No two are met at
/// one place, however many lie in one plane, and none is lost where a ray goes on behind another.
struct Place
{
    float t;   // metres
    uint rank; // hitRank()
};

/// What has alpha comes first, so that a decal in the plane of a wall lies on it; then the scene's order. Spatial splits may
/// store one triangle in several slots: its rank is one.
uint hitRank(uint triangle, uint flags)
{
    return kSceneHasAlpha && (flags & kTriangleAlpha) == 0u ? triangle | 0x80000000u : triangle;
}
uint hitRank(uint slot) { return hitRank(loadBvhTriangle(slot).triangle, loadBvhTriangle(slot).flags); }

/// Before everything at a distance greater than 0.
const Place kRayStart = Place(0.0, 0xffffffffu);

bool isBefore(Place a, Place b) { return a.t < b.t || (a.t == b.t && a.rank < b.rank); }

/// Weights of a triangle's corners where the ray passes it, times some number: of v1, v2, v0. Watertight along shared edges
/// and at shared corners (Woop et al. 2013, "Watertight Ray/Triangle Intersection"): a corner has one projection for all its
/// triangles, and each sign is that of the exact difference, or 0. Contraction to fused multiply-adds would break that, hence
/// `precise`.
/// @param a b c corners relative to the ray's origin
vec3 edgeFunctions(TriangleRay ray, vec3 a, vec3 b, vec3 c)
{
    vec3 px = vec3(a.x, b.x, c.x), py = vec3(a.y, b.y, c.y), pz = vec3(a.z, b.z, c.z);
    precise vec3 x = fma(vec3(ray.x.x), px, fma(vec3(ray.x.y), py, ray.x.z * pz)); // of the corners' projections
    precise vec3 y = fma(vec3(ray.y.x), px, fma(vec3(ray.y.y), py, ray.y.z * pz));
    precise float u = x.x * y.z - x.z * y.x;
    precise float v = x.y * y.x - x.x * y.y;
    precise float w = x.z * y.y - x.y * y.z;
    return vec3(u, v, w);
}

/// 0 counts as inside. The distance is `precise`, too: it must be one in all kernels.
/// @return whether it is met between two places (both exclusive); then `hit` and `end` are it
bool hitTriangle(uint slot, TriangleRay ray, Place start, inout Place end, inout Hit hit)
{
    vec3 a = loadBvhTriangle(slot).v0 - ray.origin;
    vec3 b = loadBvhTriangle(slot).v1 - ray.origin;
    vec3 c = loadBvhTriangle(slot).v2 - ray.origin;
    vec3 uvw = edgeFunctions(ray, a, b, c);
    if (min(uvw.x, min(uvw.y, uvw.z)) < 0.0 && max(uvw.x, max(uvw.y, uvw.z)) > 0.0)
        return false;
    precise vec3 normal = cross(a - b, c - a);
    precise float along = dot(normal, ray.direction);
    precise float t = dot(normal, a) / along;
    Place place = Place(t, hitRank(slot));
    if (!(isBefore(start, place) && isBefore(place, end))) // also refuses NaN: a ray in the triangle's plane
        return false;
    float sum = uvw.x + uvw.y + uvw.z;
    vec2 barycentrics = sum == 0.0 ? vec2(0.0) : uvw.xy / sum;
    hit = Hit(t, slot, barycentrics);
    end = place;
    return true;
}

bool comesFirst(vec3 p, vec3 q) { return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z; }

/// Of the two triangles that a ray meets where it passes exactly through their common edge, whether slot's is to count: they
/// go along it in opposite directions.
bool ownsEdge(uint slot, TriangleRay ray)
{
    vec3 v0 = loadBvhTriangle(slot).v0, v1 = loadBvhTriangle(slot).v1, v2 = loadBvhTriangle(slot).v2;
    vec3 uvw = edgeFunctions(ray, v0 - ray.origin, v1 - ray.origin, v2 - ray.origin);
    return (uvw.x != 0.0 || comesFirst(v2, v0)) && (uvw.y != 0.0 || comesFirst(v0, v1)) && (uvw.z != 0.0 || comesFirst(v1, v2));
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

// Loops here and in lib/trace.glsl test at their end. Software Vulkan takes no branch but the one back to a loop's begin:
// threads that leave at the head of a loop cost its body once more, and every body is run once at least. Mesa 22.3 gives some
// other threads wrong hits where threads have left a loop in its middle and loops follow in its body: pictures then differ from
// run to run.

// Children still to be visited, and their entry distances. Module scope, so that functions share them without copies.
uint stacked_children[kTraversalStackSize];
float stacked_entries[kTraversalStackSize]; // closest hits only
uint traversal_depth;

void push(uint child, float entry)
{
    stacked_children[traversal_depth] = child;
    stacked_entries[traversal_depth++] = entry;
}

/// The next child that is entered up to t_max, or kNone.
uint popNearer(float t_max)
{
    uint child = kNone;
    if (traversal_depth > 0u)
        for (;;)
        {
            --traversal_depth;
            if (stacked_entries[traversal_depth] <= t_max)
                child = stacked_children[traversal_depth];
            if (child != kNone || traversal_depth == 0u)
                break;
        }
    return child;
}

/// The next child in no order, or kNone.
uint popAny() { return traversal_depth > 0u ? stacked_children[--traversal_depth] : kNone; }

/// Down from a child reference to the nearest leaf below it, or where the ray misses all of them to that of the next child.
/// @return kNone: nothing is left
uint nearestLeaf(uint current, BoxRay ray, float t_min, float t_max)
{
    if ((current & kLeafBit) == 0u)
        for (;;)
        {
            vec4 t = hitBoxes(current, ray, t_min, t_max);
            uvec4 child = nodeChildren(current);
            swapIfFarther(t.x, child.x, t.y, child.y);
            swapIfFarther(t.z, child.z, t.w, child.w);
            swapIfFarther(t.x, child.x, t.z, child.z);
            swapIfFarther(t.y, child.y, t.w, child.w);
            swapIfFarther(t.y, child.y, t.z, child.z);
            if (t.w < kInfinity)
                push(child.w, t.w);
            if (t.z < kInfinity)
                push(child.z, t.z);
            if (t.y < kInfinity)
                push(child.y, t.y);
            current = t.x < kInfinity ? child.x : popNearer(t_max);
            if ((current & kLeafBit) != 0u)
                break;
        }
    return current;
}

/// The same in no order.
uint anyLeaf(uint current, BoxRay ray, float t_max)
{
    if ((current & kLeafBit) == 0u)
        for (;;)
        {
            vec4 t = hitBoxes(current, ray, 0.0, t_max);
            uvec4 child = nodeChildren(current);
            uint next = kNone;
            for (uint i = 0u; i < kBvhWidth; ++i)
                if (t[i] < kInfinity)
                {
                    if (next != kNone)
                        stacked_children[traversal_depth++] = next;
                    next = child[i];
                }
            current = next != kNone ? next : popAny();
            if ((current & kLeafBit) != 0u)
                break;
        }
    return current;
}

#endif
