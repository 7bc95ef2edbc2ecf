// Sheen of cloth: the inverted lobe of Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF", as
// KHR_materials_sheen has it. Directions are local. Functions only.
#ifndef LIB_BSDF_SHEEN_GLSL
#define LIB_BSDF_SHEEN_GLSL
#include "shaders/lib/math.glsl"

const float kLeastSheenRoughness = 0.07; // perceptual: of less, the lobe is thinner than a pixel's angles and none is seen

float sheenDistribution(float cosine, float alpha)
{
    return (2.0 + 1.0 / alpha) * pow(max(1.0 - cosine * cosine, 1e-12), 0.5 / alpha) / (2.0 * kPi);
}

/// Their fit of the masking function: coefficients for alpha 0 and 1.
float sheenCurve(float x, float alpha)
{
    float t = square(1.0 - alpha);
    float a = mix(21.5473, 25.3245, t), b = mix(3.82987, 3.32435, t), c = mix(0.19823, 0.16801, t);
    return a / (1.0 + b * pow(x, c)) + mix(-1.97760, -1.27393, t) * x + mix(-4.32054, -4.85967, t);
}

float sheenLambda(float cosine, float alpha)
{
    return exp(cosine < 0.5 ? sheenCurve(cosine, alpha) : 2.0 * sheenCurve(0.5, alpha) - sheenCurve(1.0 - cosine, alpha));
}

/// Directional albedo of the white lobe before sheenGrazing(), 1 at most. Fitted to integrals by the midpoint rule, over roughness
/// 0.07 to 1 and cosines from 0.005: within 0.022 everywhere. @param roughness perceptual
float sheenAlbedo(float roughness, float cosine)
{
    float r = max(roughness, kLeastSheenRoughness), inverse = 1.0 / r;
    float slope = exp(2.3285 + r * (-4.5197 + r * (4.0659 - r * 1.3875)) + 0.065993 * inverse);
    float bend = exp(-0.01909 + r * (-0.3623 + r * (0.52337 - r * 0.4283)) + 0.0031312 * inverse);
    float grazing = -0.57465 + r * (4.5766 + r * (-7.4482 + r * 3.5142)) - 0.053496 * inverse;
    return min(1.0, exp(-slope * pow(max(cosine, 0.0), bend) - grazing));
}

/// At the last grazing angles the masking of thin lobes, a fit, lets more back than arrives: up to 2.6 times at roughness 0.07.
/// With this factor for both directions 0.98 at most come back.
float sheenGrazing(float roughness, float cosine) { return min(1.0, cosine / max(0.115 - roughness / 2.4, 1e-6)); }

/// The white lobe, 1/sr. @param wo, wi above the surface
float sheenLobe(float roughness, vec3 wo, vec3 wi)
{
    roughness = max(roughness, kLeastSheenRoughness);
    float alpha = square(roughness);
    float masked = 4.0 * wo.z * wi.z * (1.0 + sheenLambda(wo.z, alpha) + sheenLambda(wi.z, alpha));
    float kept = sheenGrazing(roughness, wo.z) * sheenGrazing(roughness, wi.z);
    return kept * sheenDistribution(normalize(wo + wi).z, alpha) / max(masked, 1e-12);
}

#endif
