// Alpha coverage of a surface, as traversal needs it. Functions only.
#ifndef LIB_COVERAGE_GLSL
#define LIB_COVERAGE_GLSL
#include "shaders/lib/scene.glsl"
#include "shaders/lib/textures.glsl"

/// Fraction of light that a surface stops: 1 opaque, mask 0 or 1, blend its alpha (glTF 2.0, 3.9.4).
/// @param v vertices of the triangle, @param weights theirs at the point
float surfaceCoverage(uint material, uvec3 v, vec3 weights)
{
    uint flags = materials[material].flags;
    float alpha = materials[material].alpha;
    alpha *= dot(weights, vec3(unpackHalf2x16(vertices[v.x].color.y).y, unpackHalf2x16(vertices[v.y].color.y).y,
                               unpackHalf2x16(vertices[v.z].color.y).y));
    uint ref = materials[material].base_color_texture;
    if (ref != kNone)
    {
        vec2 uv0 = weights.x * vertices[v.x].uv0 + weights.y * vertices[v.y].uv0 + weights.z * vertices[v.z].uv0;
        vec2 uv1 = weights.x * vertices[v.x].uv1 + weights.y * vertices[v.y].uv1 + weights.z * vertices[v.z].uv1;
        alpha *= sampleTexture(ref, uv0, uv1, 0.0).a;
    }
    if ((flags & kMaterialAlphaMask) != 0u)
        return alpha >= materials[material].alpha_cutoff ? 1.0 : 0.0;
    return (flags & kMaterialAlphaBlend) != 0u ? clamp(alpha, 0.0, 1.0) : 1.0;
}

float surfaceCoverage(uint slot, vec2 barycentrics)
{
    vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    return surfaceCoverage(bvh_triangles[slot].material, triangles[bvh_triangles[slot].triangle].vertices, weights);
}

#endif
