// Alpha coverage of a surface, as traversal needs it. Functions only.
#ifndef LIB_COVERAGE_GLSL
#define LIB_COVERAGE_GLSL
#include "shaders/lib/scene.glsl"
#include "shaders/lib/textures.glsl"

/// Fraction of light that a surface stops: 1 opaque, mask 0 or 1, blend its alpha (glTF 2.0, 3.9.4).
/// @param v vertices of the triangle, @param weights theirs at the point
float surfaceCoverage(uint material, uvec3 v, vec3 weights)
{
    uint flags = loadMaterial(material).flags;
    float alpha = loadMaterial(material).alpha;
    alpha *= dot(weights, vec3(unpackHalf2x16(loadVertex(v.x).color.y).y, unpackHalf2x16(loadVertex(v.y).color.y).y,
                               unpackHalf2x16(loadVertex(v.z).color.y).y));
    uint ref = loadMaterial(material).base_color_texture;
    if (ref != kNone)
    {
        vec2 uv0 = weights.x * loadVertex(v.x).uv0 + weights.y * loadVertex(v.y).uv0 + weights.z * loadVertex(v.z).uv0;
        vec2 uv1 = weights.x * loadVertex(v.x).uv1 + weights.y * loadVertex(v.y).uv1 + weights.z * loadVertex(v.z).uv1;
        alpha *= sampleTexture(ref, uv0, uv1).a;
    }
    if ((flags & kMaterialAlphaMask) != 0u)
        return alpha >= loadMaterial(material).alpha_cutoff ? 1.0 : 0.0;
    return (flags & kMaterialAlphaBlend) != 0u ? clamp(alpha, 0.0, 1.0) : 1.0;
}

float surfaceCoverage(uint slot, vec2 barycentrics)
{
    vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    return surfaceCoverage(loadBvhTriangle(slot).material, loadTriangle(loadBvhTriangle(slot).triangle).vertices, weights);
}

#endif
