// Interference in a thin film over a base: the Airy sum, its harmonics averaged over what the eye sees of the spectrum
// (Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence"), as
// KHR_materials_iridescence has it. Functions only.
#ifndef LIB_BSDF_THIN_FILM_GLSL
#define LIB_BSDF_THIN_FILM_GLSL
#include "shaders/lib/bsdf/fresnel.glsl"

/// The eye's mean of cos(phase of the path difference + shift) by channel, linear Rec. 709: the Fourier transforms of
/// Gaussians fitted to the CIE colour matching functions (their section 4.2 and supplement). Each of X, Y, Z is 1 for 0.
/// @param difference nm, of the two paths' optical lengths
vec3 filmSensitivity(float difference, vec3 shift)
{
    float phase = 2.0 * kPi * difference * 1e-9;
    const vec3 kHeight = vec3(5.4856e-13, 4.4201e-13, 5.2481e-13), kPlace = vec3(1.6810e6, 1.7953e6, 2.2084e6);
    const vec3 kWidth = vec3(4.3278e9, 9.3046e9, 6.6121e9);
    vec3 xyz = kHeight * sqrt(2.0 * kPi * kWidth) * cos(kPlace * phase + shift) * exp(-kWidth * phase * phase);
    xyz.x += 9.7470e-14 * sqrt(2.0 * kPi * 4.5282e9) * cos(2.2399e6 * phase + shift.x) * exp(-4.5282e9 * phase * phase);
    xyz /= 1.0685e-7;
    return mat3(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.0415560, 1.0572252) * xyz;
}

/// Reflectance of the film and its base, outside is air. Along the normal it is within a tenth of the interference's swing, 4 times
/// the product of both boundaries' amplitudes, of Airy's sum seen by the CIE curves (thickness 100 to 1200 nm, index 1.2 to 2.4).
/// @param ior of the film, @param thickness nm, @param f0 of the base under air at normal incidence
vec3 filmReflectance(float cosine, float ior, float thickness, vec3 f0)
{
    float film = mix(1.0, ior, smoothstep(0.0, 30.0, thickness)); // a film much thinner than light's waves is none
    float sine2 = (1.0 - cosine * cosine) / (film * film);
    if (sine2 >= 1.0)
        return vec3(1.0);
    float inside = sqrt(1.0 - sine2);
    float outer = fresnelExact(cosine, film), through = 1.0 - outer;
    vec3 root = sqrt(min(f0, vec3(0.9999)));
    vec3 base_ior = (1.0 + root) / (1.0 - root);
    vec3 base_f0 = square((base_ior - film) / (base_ior + film));
    vec3 inner = base_f0 + (1.0 - base_f0) * schlick(inside);
    // Half a wave is lost where light in the film is reflected by what is less dense.
    vec3 shift = kPi * (vec3(film < 1.0 ? 0.0 : 1.0) + vec3(lessThan(base_ior, vec3(film))));
    vec3 both = clamp(outer * inner, 1e-5, 0.9999);
    vec3 single = square(through) * inner / (1.0 - both); // all orders, without interference
    vec3 sum = outer + single, order = single - through;
    float difference = 2.0 * film * thickness * inside;
    for (int m = 1; m <= 2; ++m)
    {
        order *= sqrt(both);
        sum += 2.0 * order * filmSensitivity(float(m) * difference, float(m) * shift);
    }
    return clamp(sum, 0.0, 1.0);
}

#endif
