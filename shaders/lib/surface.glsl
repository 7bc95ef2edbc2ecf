// From a hit to the surface and its material there. Functions only.
#ifndef LIB_SURFACE_GLSL
#define LIB_SURFACE_GLSL
#include "shaders/lib/math.glsl"
#include "shaders/lib/scene.glsl"
#include "shaders/lib/textures.glsl"

struct Surface
{
    vec3 position;         // metres, world
    vec3 geometric_normal; // unit, on the side the ray came from
    vec3 normal;           // shading normal, unit, same side
    vec3 smooth_normal;    // the same before the normal map: what changes slowly along a surface
    bool front;            // the ray met the triangle's front
    float area;            // square metres, of the triangle
    vec2 uv0, uv1;
    vec2 footprints;       // side of what is seen at once, in units of uv0 and uv1; 0: a point
    vec4 color;            // vertex colour
    uint material;
    uint triangle;
};

struct SurfaceMaterial // the material's values at one point, textures applied
{
    vec3 base_color;
    float metallic;
    float roughness;
    float transmission;
    float specular;
    vec3 specular_color;
    float ior;
    vec3 emission; // W/(m^2 sr)
    uint flags;    // kMaterial*
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

/// Shading normal bent by the material's normal map (glTF 2.0, 3.9.3).
vec3 mappedNormal(vec3 normal, uvec3 v, vec3 weights, Surface s)
{
    vec4 tangent = unpackTangent(loadVertex(v.x).tangent);
    vec3 t = interpolate(weights, tangent.xyz, unpackTangent(loadVertex(v.y).tangent).xyz, unpackTangent(loadVertex(v.z).tangent).xyz);
    t -= normal * dot(normal, t);
    if (dot(t, t) < 1e-12)
        return normal;
    t = normalize(t);
    vec3 texel = sampleTexture(loadMaterial(s.material).normal_texture, s.uv0, s.uv1, s.footprints).xyz * 2.0 - 1.0;
    texel.xy *= loadMaterial(s.material).normal_scale;
    vec3 bent = texel.x * t + texel.y * tangent.w * cross(normal, t) + texel.z * normal;
    return dot(bent, bent) > 1e-12 ? normalize(bent) : normal;
}

/// Surface coordinates a metre.
float uvDensity(vec2 a, vec2 b, vec2 c, float area)
{
    return sqrt(0.5 * abs(determinant(mat2(b - a, c - a))) / max(area, 1e-30));
}

/// The surface at BvhTriangle `slot`, met along `direction` by a ray as wide as `width` metres.
Surface surfaceAt(uint slot, vec2 barycentrics, vec3 direction, float width)
{
    Surface s;
    vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    vec3 v0 = loadBvhTriangle(slot).v0, v1 = loadBvhTriangle(slot).v1, v2 = loadBvhTriangle(slot).v2;
    s.position = interpolate(weights, v0, v1, v2);
    s.triangle = loadBvhTriangle(slot).triangle;
    s.material = loadBvhTriangle(slot).material;
    vec3 twice_area = cross(v1 - v0, v2 - v0);
    float doubled = length(twice_area);
    s.area = 0.5 * doubled;
    s.geometric_normal = twice_area / doubled;
    uvec3 v = loadTriangle(s.triangle).vertices;
    s.uv0 = interpolate(weights, loadVertex(v.x).uv0, loadVertex(v.y).uv0, loadVertex(v.z).uv0);
    s.uv1 = hasFeature(kFeatureSecondUv) ? interpolate(weights, loadVertex(v.x).uv1, loadVertex(v.y).uv1, loadVertex(v.z).uv1) : vec2(0.0);
    s.footprints = vec2(0.0);
    if (width > 0.0)
    {
        // As large as the ellipse that the ray's end makes.
        float side = width * inversesqrt(max(abs(dot(s.geometric_normal, direction)), 0.01));
        s.footprints.x = side * uvDensity(loadVertex(v.x).uv0, loadVertex(v.y).uv0, loadVertex(v.z).uv0, s.area);
        if (hasFeature(kFeatureSecondUv))
            s.footprints.y = side * uvDensity(loadVertex(v.x).uv1, loadVertex(v.y).uv1, loadVertex(v.z).uv1, s.area);
    }
    s.color = hasFeature(kFeatureVertexColors) ? interpolate(weights, vertexColor(v.x), vertexColor(v.y), vertexColor(v.z)) : vec4(1.0);
    vec3 normal = interpolate(weights, unpackNormal(loadVertex(v.x).normal), unpackNormal(loadVertex(v.y).normal),
                              unpackNormal(loadVertex(v.z).normal));
    s.normal = dot(normal, normal) > 1e-12 ? normalize(normal) : s.geometric_normal;
    s.smooth_normal = s.normal;
    if (hasFeature(kFeatureNormalMaps) && loadMaterial(s.material).normal_texture != kNone)
        s.normal = mappedNormal(s.normal, v, weights, s);

    s.front = dot(s.geometric_normal, direction) < 0.0;
    if (!s.front)
    {
        s.geometric_normal = -s.geometric_normal;
        s.normal = -s.normal;
        s.smooth_normal = -s.smooth_normal;
    }
    // A shading normal that looks away from the viewer is bent back until it just sees him.
    float facing = dot(s.normal, direction);
    if (facing > -1e-3)
        s.normal = normalize(s.normal - (facing + 1e-3) * direction);
    return s;
}

/// As thin as a line.
Surface surfaceAt(uint slot, vec2 barycentrics, vec3 direction) { return surfaceAt(slot, barycentrics, direction, 0.0); }

vec3 surfaceEmission(uint material, vec2 uv0, vec2 uv1, vec2 footprints)
{
    vec3 emission = loadMaterial(material).emission;
    uint ref = loadMaterial(material).emissive_texture;
    if (hasFeature(kFeatureEmissiveMaps) && ref != kNone && emission != vec3(0.0))
        emission *= sampleTexture(ref, uv0, uv1, footprints).rgb;
    return emission;
}

/// glTF 2.0 metallic-roughness and the extensions of gpu_scene.h's Material, at one point.
SurfaceMaterial materialAt(Surface s)
{
    SurfaceMaterial m;
    m.flags = loadMaterial(s.material).flags;
    m.base_color = loadMaterial(s.material).base_color * s.color.rgb;
    m.metallic = loadMaterial(s.material).metallic;
    m.roughness = loadMaterial(s.material).roughness;
    m.transmission = loadMaterial(s.material).transmission;
    m.specular = loadMaterial(s.material).specular;
    m.specular_color = loadMaterial(s.material).specular_color;
    m.ior = loadMaterial(s.material).ior;
    m.emission = surfaceEmission(s.material, s.uv0, s.uv1, s.footprints);

    uint ref = loadMaterial(s.material).base_color_texture;
    // Coarse levels mix in the colours of texels that are cut away, where any are.
    bool cut_away = (m.flags & (kMaterialAlphaMask | kMaterialAlphaBlend)) != 0u;
    if (hasFeature(kFeatureBaseColorMaps) && ref != kNone)
        m.base_color *= sampleTexture(ref, s.uv0, s.uv1, cut_away ? vec2(0.0) : s.footprints).rgb;
    ref = loadMaterial(s.material).metallic_roughness_texture;
    if (hasFeature(kFeatureMetallicRoughnessMaps) && ref != kNone)
    {
        vec4 texel = sampleTexture(ref, s.uv0, s.uv1, s.footprints);
        m.roughness *= texel.g;
        m.metallic *= texel.b;
    }
    if (!hasFeature(kFeatureRareMaps))
        return m;
    ref = loadMaterial(s.material).transmission_texture;
    if (ref != kNone)
        m.transmission *= sampleTexture(ref, s.uv0, s.uv1, s.footprints).r;
    ref = loadMaterial(s.material).specular_texture;
    if (ref != kNone)
        m.specular *= sampleTexture(ref, s.uv0, s.uv1, s.footprints).a;
    ref = loadMaterial(s.material).specular_color_texture;
    if (ref != kNone)
        m.specular_color *= sampleTexture(ref, s.uv0, s.uv1, s.footprints).rgb;
    return m;
}

bool emits(Surface s) { return s.front || (loadMaterial(s.material).flags & kMaterialDoubleSided) != 0u; }

#endif
