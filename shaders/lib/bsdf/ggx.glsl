// The GGX microfacet distribution with separable Smith masking (Walter et al. 2007), stretched along the tangent where a
// material is anisotropic (Burley 2012; KHR_materials_anisotropy). Directions are local, z along the normal, x along the
// tangent; `alphas` are the widths along x and y. Functions only.
#ifndef LIB_BSDF_GGX_GLSL
#define LIB_BSDF_GGX_GLSL
#include "shaders/lib/scene.glsl"
#include "shaders/lib/math.glsl"

float ggxDistribution(vec3 h, vec2 alphas)
{
    float alpha = alphas.y;
    if (!hasFeature(kFeatureAnisotropy) || alphas.x == alpha)
    {
        float a2 = alpha * alpha;
        float d = h.z * h.z * (a2 - 1.0) + 1.0;
        return a2 / (kPi * d * d);
    }
    vec2 slope = h.xy / alphas;
    float d = dot(slope, slope) + h.z * h.z;
    return 1.0 / (kPi * alphas.x * alphas.y * d * d);
}

float ggxMasking(vec3 v, vec2 alphas) // Smith G1
{
    float c2 = v.z * v.z, widened;
    if (!hasFeature(kFeatureAnisotropy) || alphas.x == alphas.y)
        widened = alphas.y * alphas.y * (1.0 - c2);
    else
        widened = dot(alphas * v.xy, alphas * v.xy);
    return 2.0 / (1.0 + sqrt(1.0 + widened / max(c2, 1e-12)));
}

/// A normal visible from wo (Heitz 2018, "Sampling the GGX Distribution of Visible Normals").
vec3 sampleVisibleNormal(vec3 wo, vec2 alphas, vec2 u)
{
    vec3 v = normalize(vec3(alphas * wo.xy, wo.z));
    float length2 = dot(v.xy, v.xy);
    vec3 t1 = length2 > 0.0 ? vec3(-v.y, v.x, 0.0) * inversesqrt(length2) : vec3(1.0, 0.0, 0.0);
    vec3 t2 = cross(v, t1);
    float r = sqrt(u.x), phi = 2.0 * kPi * u.y;
    float x = r * cos(phi), y = r * sin(phi);
    float s = 0.5 * (1.0 + v.z);
    y = (1.0 - s) * sqrt(max(0.0, 1.0 - x * x)) + s * y;
    vec3 n = x * t1 + y * t2 + sqrt(max(0.0, 1.0 - x * x - y * y)) * v;
    return normalize(vec3(alphas * n.xy, max(1e-6, n.z)));
}

float visibleNormalPdf(vec3 wo, vec3 h, vec2 alphas)
{
    return ggxDistribution(h, alphas) * ggxMasking(wo, alphas) * max(0.0, dot(wo, h)) / wo.z;
}

#endif
