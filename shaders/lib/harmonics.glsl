// Spherical harmonics of bands 1 to 3, and reflection in a rough lobe by them. Functions only.
#ifndef LIB_HARMONICS_GLSL
#define LIB_HARMONICS_GLSL
#include "shaders/gather/harmonics.h"
#include "shaders/lib/bsdf.glsl"

/// B_lm(d) (harmonics.h) of bands 1 (3 of them), 2 (5) and 3 (7), then a 0.
vec4[4] harmonicBasis(vec3 d)
{
    float x = d.x, y = d.y, z = d.z, z2 = z * z, across = x * x - y * y;
    const float r3 = 1.7320508, r15 = 3.8729833, r58 = 0.79056942, r38 = 0.61237244;
    return vec4[4](vec4(y, z, x, r3 * x * y),
                   vec4(r3 * y * z, 1.5 * z2 - 0.5, r3 * x * z, 0.5 * r3 * across),
                   vec4(r58 * y * (3.0 * x * x - y * y), r15 * x * y * z, r38 * y * (5.0 * z2 - 1.0), 0.5 * z * (5.0 * z2 - 3.0)),
                   vec4(r38 * x * (5.0 * z2 - 1.0), 0.5 * r15 * z * across, r58 * x * (x * x - 3.0 * y * y), 0.0));
}

/// Fraction of a surface's reflection that is computed from harmonics where samples reach it. None for
/// transmissive materials and for other lobes than one isotropic GGX lobe; almost none where hardly anything is diffuse, as
/// there are no samples on such surfaces.
float harmonicShare(Bsdf b)
{
    if (!hasFeature(kFeatureSpecular) || b.smooth_specular || b.transmission > 0.0 || hasClearcoat(b) || hasSheen(b) || isTranslucent(b) ||
        isIridescent(b) || alphas(b).x != alphas(b).y)
        return 0.0;
    return smoothstep(kHarmonicsFrom, kHarmonicsAlone, sqrt(b.alpha)) * min(1.0, 50.0 * maxComponent(diffuseColor(b)));
}

struct Reflection // by harmonics, towards one viewer
{
    vec3 direction; // that it comes from, about
    vec2 even;      // even light's answer is 1 + even.x mu + even.y P_2(mu), mu = direction . normal of the sample
    vec4 weights[4];
};

/// @param normal shading normal @param towards unit, to the viewer @param lobe of that view
Reflection reflectionBy(GlossyLobe lobe, vec3 normal, vec3 towards)
{
    vec3 across = normal * dot(normal, towards) - towards;
    float across2 = dot(across, across);
    across *= across2 > 1e-12 ? inversesqrt(across2) : 0.0;
    Reflection r;
    r.direction = normalize(normal * lobe.height + across * sqrt(max(0.0, 1.0 - square(lobe.height))));
    float a = lobe.concentration, a3 = a * a * a;
    vec3 zonal = vec3(3.0 * a, 5.0 * a3, 7.0 * a3 * a3);
    // Int cos P_l dw / pi over the hemisphere is 1, 2/3, 1/4, 0.
    r.even = zonal.xy * vec2(2.0 / 3.0, 1.0 / 4.0);
    vec4 basis[4] = harmonicBasis(r.direction);
    r.weights[0] = basis[0] * zonal.xxxy;
    r.weights[1] = basis[1] * zonal.y;
    r.weights[2] = basis[2] * zonal.z;
    r.weights[3] = basis[3] * zonal.z;
    return r;
}

/// 127 times what unpackSnorm4x8 gives of what packSnorm4x8 has made, in fewer instructions where none does it alone.
vec4 signedBytes(uint word) { return vec4(ivec4(word << 24, word << 16, word << 8, word) >> 24); }

/// What the lobe makes of one channel of a sample's light, before it is divided by evenLight.
float channelLight(Reflection r, uvec4 words)
{
    float sum = dot(r.weights[0], signedBytes(words.x)) + dot(r.weights[1], signedBytes(words.y)) +
                dot(r.weights[2], signedBytes(words.z)) + dot(r.weights[3], signedBytes(words.w));
    return 1.0 + sum * (1.0 / 127.0);
}

/// The same of even light of irradiance 1. Low bands cannot represent the darkness below the sample's horizon.
float evenLight(Reflection r, vec3 normal)
{
    float mu = dot(r.direction, normal);
    return max(0.05, 1.0 + r.even.x * mu + r.even.y * (1.5 * mu * mu - 0.5));
}

#endif
