// Directional-hemispherical reflectance of the rough reflection lobe, which has no closed form. Shared by C++ and GLSL.
// The GGX lobe of glTF 2.0, appendix B (separable Smith masking), under a Fresnel factor f0 + (f90 - f0)(1 - v.h)^5 reflects
// f0 * lobeScale + f90 * lobeBias: the split of Karis 2013, "Real Shading in Unreal Engine 4". Both are ratios of polynomials
// fitted to the integrals over roughness 0.03 to 1: at f0 0.04 and f90 1 good to 4 % from cosine 0.05 up, to 9 % below.
#ifndef LIB_LOBE_REFLECTANCE_H
#define LIB_LOBE_REFLECTANCE_H
#include "format/gpu_types.h"

GPU_NAMESPACE_BEGIN

/// @param r roughness, @param c cosine between the normal and the viewer's direction
GPU_FUNCTION float lobeScale(float r, float c)
{
    float above = -0.01291f + c * (5.47317f + c * (0.25368f + c * (-0.88583f + c * 1.40979f))) +
                  r * (-0.09960f + c * (-14.79296f + c * (7.80990f - c * 4.25924f)) +
                       r * (7.45994f + c * (-6.41547f + c * 0.74282f) + r * (1.22502f + c * 6.70709f - r * 4.19824f)));
    float below = 1.0f + c * (2.26345f + c * 2.99886f) + r * (-1.18934f - c * 11.34165f + r * 7.67816f);
    return above / below;
}

GPU_FUNCTION float lobeBias(float r, float c)
{
    float above = 0.98144f + c * (-3.39781f + c * (4.27132f + c * (-2.33329f + c * 0.48526f))) +
                  r * (-1.24359f + c * (3.63923f + c * (-3.38778f + c * 0.93467f)) +
                       r * (0.61495f + c * (-1.13548f + c * 0.69976f) + r * (-0.27722f + c * 0.03464f + r * 0.11775f)));
    float below = 1.0f + c * (0.84025f + c * 6.32666f) + r * (-0.82584f - c * 12.49818f + r * 9.90706f);
    return above / below;
}

GPU_NAMESPACE_END
#endif
