// From a hit to the surface there. Functions only.
#ifndef LIB_SURFACE_GLSL
#define LIB_SURFACE_GLSL
#include "shaders/lib/math.glsl"
#include "shaders/lib/scene.glsl"
#include "shaders/lib/textures.glsl"
#include "shaders/rays/rays.h"

struct Surface
{
    vec3 position;         // metres, world
    vec3 direction;        // unit, of the ray that arrived
    float error;           // metres, that rounding may have put `position` off the surface
    float back;            // metres, back along `direction` to where rays leave on the side it came from
    bool lifted;           // that is well above the triangle: on the smooth surface that the normals describe
    vec3 geometric_normal; // unit, on the side the ray came from
    vec3 normal;           // shading normal, unit, same side
    vec3 smooth_normal;    // the same before the normal map: what changes slowly along a surface
    vec3 tangent, bitangent; // unit, across the smooth normal, along u and against v; 0 where no vertex has them
    bool front;            // the ray met the triangle's front
    float area;            // square metres, of the triangle
    vec2 uv0, uv1;
    Footprints footprints; // what of uv0 and uv1 is seen at once
    vec4 color;            // vertex colour
    uint material;
    uint triangle;
};

vec3 interpolate(vec3 weights, vec3 a, vec3 b, vec3 c) { return weights.x * a + weights.y * b + weights.z * c; }
vec2 interpolate(vec3 weights, vec2 a, vec2 b, vec2 c) { return weights.x * a + weights.y * b + weights.z * c; }
vec4 interpolate(vec3 weights, vec4 a, vec4 b, vec4 c) { return weights.x * a + weights.y * b + weights.z * c; }

vec4 vertexColor(uint vertex)
{
    return vec4(unpackHalf2x16(loadVertex(vertex).color.x), unpackHalf2x16(loadVertex(vertex).color.y));
}

/// Tangent with the sign of the bitangent in w; layout as in gpu_scene.h.
vec4 unpackTangent(uint bits)
{
    float x = clamp(float(bitfieldExtract(int(bits), 0, 16)) / 32767.0, -1.0, 1.0);
    float y = clamp(float(bitfieldExtract(int(bits), 17, 15)) / 16383.0, -1.0, 1.0);
    return vec4(octahedralToUnit(vec2(x, y)), (bits & 0x10000u) != 0u ? -1.0 : 1.0);
}

/// Tangent and bitangent across a unit normal, from the vertices'; unchanged where these are none.
void setTangents(inout Surface s, vec3 normal, uvec3 v, vec3 weights)
{
    vec4 tangent = unpackTangent(loadVertex(v.x).tangent);
    vec3 t = interpolate(weights, tangent.xyz, unpackTangent(loadVertex(v.y).tangent).xyz, unpackTangent(loadVertex(v.z).tangent).xyz);
    t -= normal * dot(normal, t);
    if (dot(t, t) < 1e-12)
        return;
    s.tangent = normalize(t);
    s.bitangent = tangent.w * cross(normal, s.tangent);
}

/// A normal bent by a normal map (glTF 2.0, 3.9.3). @param ref index into TextureRefs
vec3 mappedNormal(vec3 normal, uint ref, float scale, Surface s)
{
    if (s.tangent == vec3(0.0))
        return normal;
    vec3 texel = sampleNormal(ref, s.uv0, s.uv1, s.footprints);
    texel.xy *= scale;
    vec3 bent = texel.x * s.tangent + texel.y * s.bitangent + texel.z * normal;
    return dot(bent, bent) > 1e-12 ? normalize(bent) : normal;
}

/// What a ray of round cross-section covers of a triangle's plane: axes of an ellipse, as surface coordinates.
/// @param along_u, along_v gradients of the second and the third barycentric coordinate, 1/m
mat2 footprintOn(mat2x3 axes, vec3 along_u, vec3 along_v, vec2 a, vec2 b, vec2 c)
{
    return mat2(b - a, c - a) * mat2(dot(axes[0], along_u), dot(axes[0], along_v), dot(axes[1], along_u), dot(axes[1], along_v));
}

/// How much farther along a vertex' normal its tangent plane is than the point. Packed normals are exact to 3e-5 radians.
float tangentPlaneHeight(vec3 point, vec3 vertex, vec3 normal, float size)
{
    return max(0.0, dot(vertex - point, normal) - 1e-4 * size);
}

/// Height above a point of a triangle of the smooth surface that the normals describe, where it is convex (Hanika 2021,
/// "Hacking the Shadow Terminator"). 0 where the normals are far from the triangle's: they then describe no surface.
/// @param normals of the vertices, unit, on one side of the triangle as its `normal` is; @param size metres, of the triangle
float smoothHeight(vec3 point, vec3 weights, vec3 v[3], vec3 normals[3], vec3 normal, float size)
{
    float height = 0.0, agreement = 1.0;
    for (uint i = 0u; i < 3u; ++i)
    {
        float cosine = dot(normals[i], normal);
        height += weights[i] * tangentPlaneHeight(point, v[i], normals[i], size) * cosine;
        agreement = min(agreement, cosine);
    }
    return height * smoothstep(0.6, 0.8, agreement);
}

/// How far back along the ray that arrived a point is off the surface by more than rounding. On that way nothing is met:
/// an offset along the normal could lead through another surface close by, and half as much might, so close to an edge that
/// rounding put the point behind the other surface there.
float clearance(Surface s)
{
    return 2.0 * s.error / max(-dot(s.geometric_normal, s.direction), 1.0 / 64.0);
}

/// A shading normal on the other side of its triangle is mirrored to this one.
vec3 onSideOf(vec3 geometric_normal, vec3 normal)
{
    return normal - 2.0 * min(0.0, dot(normal, geometric_normal)) * geometric_normal;
}

/// Turns a shading normal towards the geometric one n until what it mirrors of the viewer's direction wo leaves the surface.
/// In the plane of both normals, with T across n, wo is (a, b), and a normal at angle phi to n mirrors it to
/// a cos 2 phi + b sin 2 phi above the surface: that is `least` where 2 phi = atan(b, a) + acos(least / |(a, b)|), and more
/// for every smaller phi. Then wo is above the shading normal's horizon, too.
vec3 mirroringNormal(vec3 normal, vec3 n, vec3 wo)
{
    float a = max(dot(n, wo), 1e-5), least = min(0.5 * a, 0.01);
    if (2.0 * dot(normal, wo) * dot(normal, n) - a >= least)
        return normal;
    vec3 across = normal - n * dot(normal, n);
    if (dot(across, across) < 1e-12)
        return n;
    across = normalize(across);
    float b = dot(across, wo), inverse = inversesqrt(a * a + b * b), cosine = least * inverse;
    float doubled = (a * cosine - b * sqrt(1.0 - cosine * cosine)) * inverse; // cos 2 phi
    return n * sqrt(0.5 + 0.5 * doubled) + across * sqrt(max(0.0, 0.5 - 0.5 * doubled));
}

bool isMatte(uint material)
{
    return !hasFeature(kFeatureSpecular) ||
           (loadMaterial(material).specular == 0.0 && loadMaterial(material).metallic == 0.0 && loadMaterial(material).transmission == 0.0 &&
            !(hasFeature(kFeatureClearcoat) && loadMaterial(material).clearcoat > 0.0) &&
            !(hasFeature(kFeatureSheen) && loadMaterial(material).sheen_color != vec3(0.0)));
}

/// A shading normal that mirrors the viewer's direction away from the surface, and faces the viewer.
vec3 facingNormal(vec3 normal, Surface s)
{
    normal = mirroringNormal(normal, s.geometric_normal, -s.direction);
    float facing = dot(normal, s.direction);
    return facing > -1e-4 ? normalize(normal - (facing + 1e-4) * s.direction) : normal;
}

/// Normal of the clear coat: the smooth one, or that of the coat's own map (KHR_materials_clearcoat).
vec3 clearcoatNormal(Surface s)
{
    uint ref = loadMaterial(s.material).clearcoat_normal_texture;
    vec3 normal = s.smooth_normal;
    if (hasFeature(kFeatureRareMaps) && ref != kNone)
    {
        float side = s.front ? 1.0 : -1.0; // tangents are those of the front
        normal = side * mappedNormal(side * normal, ref, loadMaterial(s.material).clearcoat_normal_scale, s);
        normal = onSideOf(s.geometric_normal, normal);
    }
    return facingNormal(normal, s);
}

/// Shading normals and the start of leaving rays. Expects all of s but them.
void setNormals(inout Surface s, vec3 v[3], uvec3 vertex, vec3 weights)
{
    vec3 normals[3] = vec3[3](unpackNormal(loadVertex(vertex.x).normal), unpackNormal(loadVertex(vertex.y).normal),
                              unpackNormal(loadVertex(vertex.z).normal));
    vec3 winding = s.front ? s.geometric_normal : -s.geometric_normal;
    bool opposed = max(dot(normals[0], winding), max(dot(normals[1], winding), dot(normals[2], winding))) < 0.0;
    for (uint i = 0u; i < 3u; ++i) // of an inside-out triangle they mean the other side
        normals[i] = opposed ? -normals[i] : normals[i];
    vec3 normal = interpolate(weights, normals[0], normals[1], normals[2]);
    normal = dot(normal, normal) > 1e-12 ? onSideOf(winding, normalize(normal)) : winding;
    s.normal = normal;
    s.tangent = s.bitangent = vec3(0.0);
    if (hasFeature(kFeatureNormalMaps | kFeatureAnisotropy))
        setTangents(s, normal, vertex, weights);
    if (hasFeature(kFeatureNormalMaps) && loadMaterial(s.material).normal_texture != kNone)
        s.normal = onSideOf(winding, mappedNormal(normal, loadMaterial(s.material).normal_texture, loadMaterial(s.material).normal_scale, s));
    float side = s.front ? 1.0 : -1.0;
    s.normal *= side;
    s.smooth_normal = normal * side;
    for (uint i = 0u; i < 3u; ++i)
        normals[i] *= side;
    float height = smoothHeight(s.position, weights, v, normals, s.geometric_normal, sqrt(2.0 * s.area));
    s.lifted = height > 4.0 * s.error;
    s.back = clearance(s);
    if (s.lifted) // along the ray, too; very oblique ones stay lower rather than come from elsewhere
        s.back = max(s.back, height / max(-dot(s.geometric_normal, s.direction), 0.25));
    if (isMatte(s.material)) // matter without a mirror looks the same from everywhere
        return;
    s.normal = facingNormal(s.normal, s);
}

const float kLeastCosine = 0.01; // beyond that a ray's end is no longer

/// @param edge_u, edge_v of the triangle, from its first vertex; @param v its vertices; @param width metres, of the ray
void setFootprints(inout Surface s, vec3 edge_u, vec3 edge_v, uvec3 v, float width)
{
    mat3 across = frameAround(s.direction);
    float cosine = dot(s.geometric_normal, s.direction); // < 0
    vec3 per_height = s.direction / min(cosine, -kLeastCosine);
    mat2x3 axes = width * mat2x3(across[0] - dot(s.geometric_normal, across[0]) * per_height,
                                 across[1] - dot(s.geometric_normal, across[1]) * per_height); // carried along the ray onto the plane
    vec3 n = 0.5 / s.area * s.geometric_normal; // its sign does not matter to an ellipse
    vec3 along_u = cross(edge_v, n), along_v = cross(n, edge_u);
    s.footprints.uv0 = footprintOn(axes, along_u, along_v, loadVertex(v.x).uv0, loadVertex(v.y).uv0, loadVertex(v.z).uv0);
    if (hasFeature(kFeatureSecondUv))
        s.footprints.uv1 = footprintOn(axes, along_u, along_v, loadVertex(v.x).uv1, loadVertex(v.y).uv1, loadVertex(v.z).uv1);
}

/// The surface at BvhTriangle `slot`, met along `direction` by a ray as wide as `width` metres.
Surface surfaceAt(uint slot, vec2 barycentrics, vec3 direction, float width)
{
    Surface s;
    vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    vec3 v0 = loadBvhTriangle(slot).v0, v1 = loadBvhTriangle(slot).v1, v2 = loadBvhTriangle(slot).v2;
    s.position = v0 + (barycentrics.x * (v1 - v0) + barycentrics.y * (v2 - v0)); // rounded once, far from the origin
    s.direction = direction;
    s.error = planeError(v0, v1, v2, vec3(0.0)) + kRounding * maxComponent(largestMagnitude(v0, v1, v2));
    s.triangle = loadBvhTriangle(slot).triangle;
    s.material = loadBvhTriangle(slot).material;
    vec3 twice_area = cross(v1 - v0, v2 - v0);
    float doubled = length(twice_area);
    s.area = 0.5 * doubled;
    s.geometric_normal = twice_area / doubled;
    s.front = dot(s.geometric_normal, direction) < 0.0;
    s.geometric_normal = s.front ? s.geometric_normal : -s.geometric_normal;
    uvec3 v = loadTriangle(s.triangle).vertices;
    s.uv0 = interpolate(weights, loadVertex(v.x).uv0, loadVertex(v.y).uv0, loadVertex(v.z).uv0);
    s.uv1 = hasFeature(kFeatureSecondUv) ? interpolate(weights, loadVertex(v.x).uv1, loadVertex(v.y).uv1, loadVertex(v.z).uv1) : vec2(0.0);
    s.footprints = kPoint;
    if (width > 0.0)
        setFootprints(s, v1 - v0, v2 - v0, v, width);
    s.color = hasFeature(kFeatureVertexColors) ? interpolate(weights, vertexColor(v.x), vertexColor(v.y), vertexColor(v.z)) : vec4(1.0);
    setNormals(s, vec3[3](v0, v1, v2), v, weights);
    return s;
}

/// As thin as a line.
Surface surfaceAt(uint slot, vec2 barycentrics, vec3 direction) { return surfaceAt(slot, barycentrics, direction, 0.0); }

/// The surface where a ray met it. On a triangle that is large relative to the ray's length, the position is computed along the
/// ray, which is more precise.
Surface surfaceAt(Ray ray, Hit hit, float width)
{
    Surface s = surfaceAt(hit.slot, hit.barycentrics, ray.direction, width);
    vec3 v0 = loadBvhTriangle(hit.slot).v0, v1 = loadBvhTriangle(hit.slot).v1, v2 = loadBvhTriangle(hit.slot).v2;
    vec3 reach = abs(ray.origin) + hit.t * abs(ray.direction);
    if (maxComponent(reach) < maxComponent(largestMagnitude(v0, v1, v2)))
    {
        s.position = ray.origin + hit.t * ray.direction;
        s.error = planeError(v0, v1, v2, reach) + kRounding * maxComponent(reach);
    }
    s.back = min(s.lifted ? max(clearance(s), s.back) : clearance(s), 0.5 * hit.t);
    return s;
}
Surface surfaceAt(Ray ray, Hit hit) { return surfaceAt(ray, hit, 0.0); }

#endif
