// Display transforms: linear Rec. 709 radiance to display-referred, still linear RGB in [0,1]. Functions only.
#ifndef LIB_TONEMAP_GLSL
#define LIB_TONEMAP_GLSL
#include "shaders/resolve/resolve.h"

vec3 toSrgb(vec3 linear)
{
    vec3 x = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

/// Narkowicz's 2015 fit of the ACES reference curve, per channel.
vec3 tonemapAces(vec3 x)
{
    x = min(x, 1e4); // white long before; squares of much more overflow
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

/// AgX in short (after Sobotka's): mix the channels so that bright colours go to white, a log2 sigmoid between -12.47
/// and +4.03 stops around 0.18, mix back.
vec3 tonemapAgx(vec3 rgb)
{
    const mat3 kInset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992, 0.878468636469772,
                             0.0784336, 0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    const float kMinStops = -12.47393, kMaxStops = 4.026069;
    vec3 x = (log2(max(kInset * max(rgb, 0.0), 1e-10)) - kMinStops) / (kMaxStops - kMinStops);
    x = clamp(x, 0.0, 1.0);
    vec3 x2 = x * x, x4 = x2 * x2;
    vec3 curve = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
    return clamp(pow(max(inverse(kInset) * curve, 0.0), vec3(2.2)), 0.0, 1.0);
}

/// @param curve kTonemap*
vec3 displayTransform(vec3 rgb, uint curve)
{
    if (curve == kTonemapAces)
        return tonemapAces(rgb);
    if (curve == kTonemapAgx)
        return tonemapAgx(rgb);
    return clamp(rgb, 0.0, 1.0);
}

#endif
