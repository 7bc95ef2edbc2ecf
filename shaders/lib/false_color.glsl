// Colours of debug views: display-referred, linear Rec. 709 in [0,1]. Functions only.
#ifndef LIB_FALSE_COLOR_GLSL
#define LIB_FALSE_COLOR_GLSL
#include "shaders/lib/math.glsl"
#include "shaders/lib/random.glsl"
#include "shaders/lib/tonemap.glsl"

vec3 fromSrgb(vec3 srgb)
{
    vec3 linear = mix(pow((srgb + 0.055) / 1.055, vec3(2.4)), srgb / 12.92, lessThanEqual(srgb, vec3(0.04045)));
    return min(linear, 1.0); // pow() may round up
}

/// One of 2^24 light colours, another for nearly every index.
vec3 indexColor(uint index)
{
    uint bits = hash(index);
    vec3 rgb = vec3(uvec3(bits, bits >> 8, bits >> 16) & 0xffu) / 255.0;
    return fromSrgb(0.25 + 0.75 * rgb);
}

/// Dark blue over green to yellow, evenly brighter with t in [0,1]: five colours of the viridis map.
vec3 heatColor(float t)
{
    const vec3 kColors[5] = vec3[5](vec3(68.0, 1.0, 84.0), vec3(59.0, 82.0, 139.0), vec3(33.0, 145.0, 140.0), vec3(94.0, 201.0, 98.0),
                                    vec3(253.0, 231.0, 37.0));
    float at = 4.0 * clamp(t, 0.0, 1.0);
    uint i = min(uint(at), 3u);
    return fromSrgb(mix(kColors[i], kColors[i + 1u], at - float(i)) / 255.0);
}

/// The picture as a dim, bluish background for bright colours.
vec3 groundColor(vec3 radiance, float exposure, uint curve)
{
    return luminance(displayTransform(exposure * radiance, curve)) * vec3(0.08, 0.16, 0.4);
}

#endif
