// The material at one point as layers, from the top: a clear coat, a sheen, a dielectric or metallic surface (under a thin
// film where it is iridescent), and below it what scatters or transmits. glTF 2.0 appendix B, KHR_materials_*.
//
// A layer takes its albedo from those below it both on the way in and on the way out; of the two it is the larger share that
// counts (as KHR_materials_sheen says): so the whole is reciprocal, and never sends back more than arrives.
// Directions are local: z along the shading normal on the viewer's side. Functions only.
#ifndef LIB_BSDF_LAYERS_GLSL
#define LIB_BSDF_LAYERS_GLSL
#include "shaders/lib/bsdf/ggx.glsl"
#include "shaders/lib/bsdf/sheen.glsl"
#include "shaders/lib/bsdf/thin_film.glsl"
#include "shaders/lib/lobe_reflectance.h"
#include "shaders/lib/material.glsl"

struct Bsdf
{
    vec3 base_color;
    float metallic;
    vec3 f0;            // dielectric reflectance at normal incidence, KHR_materials_specular applied
    float f90;
    float alpha;        // GGX width, roughness^2; of a stretched lobe across the tangent
    float stretched;    // the width along the tangent
    float transmission;
    float eta;          // index behind the surface / index on the viewer's side
    bool smooth_specular;   // reflection and transmission are delta lobes
    bool thin;
    vec3 dispersed;     // what transmitted light is worth by channel: all on one where the path stands for one
    float diffuse_transmission;
    vec3 diffuse_transmission_color;
    float clearcoat;
    float clearcoat_alpha;
    bool smooth_clearcoat;
    vec3 clearcoat_normal;  // local
    vec3 sheen_color;
    float sheen_roughness;  // perceptual
    float iridescence;
    float film_ior;
    float film_thickness;   // nm
};

bool hasClearcoat(Bsdf b) { return hasFeature(kFeatureClearcoat) && b.clearcoat > 0.0; }
bool hasSheen(Bsdf b) { return hasFeature(kFeatureSheen) && b.sheen_color != vec3(0.0); }
bool isIridescent(Bsdf b) { return hasFeature(kFeatureIridescence) && b.iridescence > 0.0; }
bool isTranslucent(Bsdf b) { return hasFeature(kFeatureDiffuseTransmission) && b.diffuse_transmission > 0.0; }
vec2 alphas(Bsdf b) { return hasFeature(kFeatureAnisotropy) ? vec2(b.stretched, b.alpha) : vec2(b.alpha); }

/// @param clearcoat_normal local
Bsdf bsdfAt(SurfaceMaterial m, bool front, vec3 clearcoat_normal)
{
    Bsdf b;
    b.base_color = m.base_color;
    b.metallic = hasFeature(kFeatureMetal) ? m.metallic : 0.0;
    b.f0 = min(normalReflectance(m.ior) * m.specular_color, vec3(1.0)) * m.specular;
    b.f90 = m.specular;
    b.alpha = max(square(m.roughness), square(kSmoothRoughness));
    b.stretched = mix(b.alpha, 1.0, square(m.anisotropy));
    b.smooth_specular = hasFeature(kFeatureDeltaLobes) && m.roughness < kSmoothRoughness && b.stretched == b.alpha;
    b.transmission = hasFeature(kFeatureTransmission) ? m.transmission : 0.0;
    b.thin = (m.flags & kMaterialThin) != 0u;
    b.eta = front || b.thin ? m.ior : 1.0 / m.ior;
    b.dispersed = vec3(1.0);
    b.diffuse_transmission = m.diffuse_transmission;
    b.diffuse_transmission_color = m.diffuse_transmission_color;
    bool outside = front || b.thin || b.transmission == 0.0; // coats and cloth lie on the outside of solid bodies
    b.clearcoat = outside ? m.clearcoat : 0.0;
    b.clearcoat_alpha = max(square(m.clearcoat_roughness), square(kSmoothRoughness));
    b.smooth_clearcoat = hasFeature(kFeatureDeltaLobes) && m.clearcoat_roughness < kSmoothRoughness;
    b.clearcoat_normal = clearcoat_normal;
    b.sheen_color = outside ? m.sheen_color : vec3(0.0);
    b.sheen_roughness = m.sheen_roughness;
    b.iridescence = m.iridescence;
    b.film_ior = m.iridescence_ior;
    b.film_thickness = m.iridescence_thickness;
    return b;
}

// ---- The surface -----------------------------------------------------------------------------------------------------

/// Reflectance of the dielectric layer. Transmissive surfaces take the exact curve, rescaled to f0..f90.
vec3 dielectricFresnel(Bsdf b, float cosine)
{
    float rise = schlick(cosine);
    if (!hasFeature(kFeatureSpecular))
        return vec3(0.0);
    if (hasFeature(kFeatureTransmission) && b.transmission > 0.0)
    {
        float normal = normalReflectance(b.eta);
        rise = normal < 1.0 ? clamp((fresnelExact(cosine, b.eta) - normal) / (1.0 - normal), 0.0, 1.0) : 1.0;
    }
    vec3 plain = b.f0 + (vec3(b.f90) - b.f0) * rise;
    if (!isIridescent(b) || (!b.thin && b.eta < 1.0)) // from inside a body the film is behind the boundary: as without it
        return plain;
    return mix(plain, b.f90 * filmReflectance(cosine, b.film_ior, b.film_thickness, b.f0 / max(b.f90, 1e-6)), b.iridescence);
}

/// What the specular reflection lobe is multiplied with: metal and dielectric share one GGX lobe.
vec3 reflectionColor(Bsdf b, float cosine)
{
    vec3 metal = b.base_color + (1.0 - b.base_color) * schlick(cosine);
    if (isIridescent(b) && b.metallic > 0.0)
        metal = mix(metal, filmReflectance(cosine, b.film_ior, b.film_thickness, b.base_color), b.iridescence);
    return mix(dielectricFresnel(b, cosine), metal, b.metallic);
}

/// Share of light that passes the dielectric layer.
float passedShare(Bsdf b, float cosine) { return (1.0 - b.metallic) * (1.0 - maxComponent(dielectricFresnel(b, cosine))); }

/// What is left for the layer below, diffuse reflection and transmission together.
vec3 belowColor(Bsdf b, float cosine) { return passedShare(b, cosine) * b.base_color; }

/// Shares of what passes.
float reflectedShare(Bsdf b)
{
    float share = 1.0 - b.transmission;
    return isTranslucent(b) ? share * (1.0 - b.diffuse_transmission) : share;
}
float translucentShare(Bsdf b) { return isTranslucent(b) ? (1.0 - b.transmission) * b.diffuse_transmission : 0.0; }

/// Colour of the diffuse lobe before the dielectric layer above it takes its share; black where there is none.
vec3 diffuseColor(Bsdf b) { return (1.0 - b.metallic) * reflectedShare(b) * b.base_color; }

// ---- The layers above it ---------------------------------------------------------------------------------------------

const float kClearcoatF0 = 0.04; // index 1.5 (KHR_materials_clearcoat)

mat3 clearcoatFrame(Bsdf b) { return frameAround(b.clearcoat_normal); }
/// Cosine between a direction and the coat's normal, on the side of the surface that the direction is on.
float clearcoatCosine(Bsdf b, vec3 w) { return max(dot(vec3(w.xy, abs(w.z)), b.clearcoat_normal), 1e-4); }
float clearcoatFresnel(Bsdf b, float cosine) { return b.clearcoat * (kClearcoatF0 + (1.0 - kClearcoatF0) * schlick(cosine)); }

/// Directional albedo.
float clearcoatAlbedo(Bsdf b, float cosine)
{
    if (b.smooth_clearcoat)
        return clearcoatFresnel(b, cosine);
    float roughness = sqrt(b.clearcoat_alpha);
    return b.clearcoat * clamp(kClearcoatF0 * lobeScale(roughness, cosine) + lobeBias(roughness, cosine), 0.0, 1.0);
}
float sheenShare(Bsdf b, float cosine) { return maxComponent(b.sheen_color) * sheenAlbedo(b.sheen_roughness, cosine); }

/// What the layers above let through from wi to wo.
float covered(Bsdf b, vec3 wo, vec3 wi)
{
    float kept = 1.0;
    if (hasClearcoat(b))
        kept *= 1.0 - max(clearcoatAlbedo(b, clearcoatCosine(b, wo)), clearcoatAlbedo(b, clearcoatCosine(b, wi)));
    if (hasSheen(b))
        kept *= 1.0 - max(sheenShare(b, abs(wo.z)), sheenShare(b, abs(wi.z)));
    return kept;
}

/// The mean of that over even light from above. The midpoint rule in equal steps of projected solid angle.
float coveredEvenly(Bsdf b, float cosine)
{
    const int kSteps = 6;
    if (!hasClearcoat(b) && !hasSheen(b))
        return 1.0;
    float sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
    {
        float other = sqrt((float(i) + 0.5) / float(kSteps)), kept = 1.0;
        if (hasClearcoat(b))
            kept *= 1.0 - max(clearcoatAlbedo(b, cosine), clearcoatAlbedo(b, other));
        if (hasSheen(b))
            kept *= 1.0 - max(sheenShare(b, cosine), sheenShare(b, other));
        sum += kept;
    }
    return sum / float(kSteps);
}

// ---- Directional-hemispherical reflectances --------------------------------------------------------------------------

/// Mean of 1 - the dielectric layer's reflectance over even light. The layer's (1 - wo.h)^5 has no closed form over the
/// hemisphere: a cubic in wo's cosine, good to 1e-4.
float passedEvenly(Bsdf b, float cosine)
{
    if (!hasFeature(kFeatureSpecular))
        return 1.0;
    float mean_rise = 0.0280436 + cosine * (-0.0772954 + cosine * (0.0747859 - 0.0255469 * cosine));
    float passed = 1.0 - maxComponent(b.f0 + (vec3(b.f90) - b.f0) * mean_rise);
    return passed * coveredEvenly(b, cosine);
}

vec3 diffuseReflectance(Bsdf b, float cosine) { return diffuseColor(b) * passedEvenly(b, cosine); }

/// Of light from behind.
vec3 diffuseTransmittance(Bsdf b, float cosine)
{
    return (1.0 - b.metallic) * translucentShare(b) * b.diffuse_transmission_color * passedEvenly(b, cosine);
}

/// Of the rough reflection lobes, those of the layers above included; a smooth one counts 0.
vec3 glossyReflectance(Bsdf b, float cosine)
{
    if (!hasFeature(kFeatureSpecular))
        return vec3(0.0);
    vec3 sum = vec3(0.0);
    if (!b.smooth_specular)
    {
        float roughness = sqrt(sqrt(alphas(b).x * alphas(b).y));
        vec3 f0 = isIridescent(b) ? reflectionColor(b, cosine) : mix(b.f0, b.base_color, b.metallic);
        float f90 = isIridescent(b) ? 1.0 : mix(b.f90, 1.0, b.metallic);
        sum = clamp(f0 * lobeScale(roughness, cosine) + f90 * lobeBias(roughness, cosine), 0.0, 1.0) * coveredEvenly(b, cosine);
    }
    if (hasClearcoat(b) && !b.smooth_clearcoat)
        sum += clearcoatAlbedo(b, cosine);
    if (hasSheen(b))
        sum += b.sheen_color * sheenAlbedo(b.sheen_roughness, cosine);
    return sum;
}

/// Of all rough lobes but the diffuse one, what passes through the surface included; of smooth ones only what passes.
vec3 specularReflectance(Bsdf b, float cosine)
{
    vec3 passed = belowColor(b, cosine) * b.transmission;
    if (isTranslucent(b))
        passed += diffuseTransmittance(b, cosine);
    return glossyReflectance(b, cosine) + passed;
}

/// Width of the sharpest lobe that is neither smooth nor diffuse; 1 where there is none.
float sharpestAlpha(Bsdf b)
{
    float alpha = b.smooth_specular ? 1.0 : b.alpha;
    return hasClearcoat(b) && !b.smooth_clearcoat ? min(alpha, b.clearcoat_alpha) : alpha;
}

/// Whether some lobe is neither diffuse nor a delta.
bool hasGlossyLobe(Bsdf b)
{
    return !b.smooth_specular || (hasClearcoat(b) && !b.smooth_clearcoat) || hasSheen(b) || isTranslucent(b);
}

/// Whether any lobe can be evaluated for a given direction, that is: whether light sampling makes sense.
bool hasDensity(Bsdf b) { return hasGlossyLobe(b) || diffuseColor(b) != vec3(0.0); }

#endif
