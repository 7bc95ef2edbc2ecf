// Reflectance of smooth boundaries. Functions only.
#ifndef LIB_BSDF_FRESNEL_GLSL
#define LIB_BSDF_FRESNEL_GLSL
#include "shaders/lib/math.glsl"

float schlick(float cosine) // the power only
{
    float x = clamp(1.0 - cosine, 0.0, 1.0);
    return x * x * x * x * x;
}

/// Unpolarised Fresnel reflectance of a dielectric boundary; 1 under total internal reflection.
/// @param eta index behind the boundary / index on the viewer's side
float fresnelExact(float cosine, float eta)
{
    float sin2_t = (1.0 - cosine * cosine) / (eta * eta);
    if (sin2_t >= 1.0)
        return 1.0;
    float cos_t = sqrt(1.0 - sin2_t);
    float parallel = (eta * cosine - cos_t) / (eta * cosine + cos_t);
    float perpendicular = (cosine - eta * cos_t) / (cosine + eta * cos_t);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

/// The same at normal incidence.
float normalReflectance(float eta) { return square((eta - 1.0) / (eta + 1.0)); }

#endif
