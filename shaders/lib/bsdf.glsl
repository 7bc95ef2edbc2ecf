// The glTF BSDF: Lambert under a GGX dielectric layer, GGX metal, smooth and rough dielectric transmission.
// glTF 2.0 appendix B (separable Smith masking, Schlick Fresnel), KHR_materials_specular, _ior, _transmission, _volume.
// Directions are local: z along the shading normal on the viewer's side, wo.z > 0 but for matter without specular lobes.
// Functions only.
#ifndef LIB_BSDF_GLSL
#define LIB_BSDF_GLSL
#include "shaders/lib/lobe_reflectance.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/surface.glsl"

struct Bsdf
{
    vec3 base_color;
    float metallic;
    vec3 f0;            // dielectric reflectance at normal incidence, KHR_materials_specular applied
    float f90;
    float alpha;        // GGX width, roughness^2
    float transmission;
    float eta;          // index behind the surface / index on the viewer's side
    bool smooth_specular;   // reflection and transmission are delta lobes
    bool thin;
};

struct BsdfSample
{
    vec3 wi;     // local; below the surface for transmission
    vec3 weight; // f |cos| / pdf; zero: absorbed
    vec3 diffuse_weight; // the diffuse lobe's part of it
    float pdf;   // per steradian, 0 for a delta lobe
    bool passed; // went straight through a thin smooth wall: not a scattering event
};

Bsdf bsdfAt(SurfaceMaterial m, bool front)
{
    Bsdf b;
    b.base_color = m.base_color;
    b.metallic = hasFeature(kFeatureMetal) ? m.metallic : 0.0;
    b.f0 = min(square((m.ior - 1.0) / (m.ior + 1.0)) * m.specular_color, vec3(1.0)) * m.specular;
    b.f90 = m.specular;
    b.smooth_specular = hasFeature(kFeatureSpecular) && m.roughness < kSmoothRoughness;
    b.alpha = max(square(m.roughness), square(kSmoothRoughness));
    b.transmission = hasFeature(kFeatureTransmission) ? m.transmission : 0.0;
    b.thin = (m.flags & kMaterialThin) != 0u;
    b.eta = front || b.thin ? m.ior : 1.0 / m.ior;
    return b;
}

float schlick(float cosine) // the power only
{
    float x = clamp(1.0 - cosine, 0.0, 1.0);
    return x * x * x * x * x;
}

/// Unpolarised Fresnel reflectance of a dielectric boundary; 1 under total internal reflection.
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

/// Reflectance of the dielectric layer. Transmissive surfaces take the exact curve, rescaled to f0..f90.
vec3 dielectricFresnel(Bsdf b, float cosine)
{
    float rise = schlick(cosine);
    if (!hasFeature(kFeatureSpecular))
        return vec3(0.0);
    if (hasFeature(kFeatureTransmission) && b.transmission > 0.0)
    {
        float normal = square((b.eta - 1.0) / (b.eta + 1.0));
        rise = normal < 1.0 ? clamp((fresnelExact(cosine, b.eta) - normal) / (1.0 - normal), 0.0, 1.0) : 1.0;
    }
    return b.f0 + (vec3(b.f90) - b.f0) * rise;
}

/// What the specular reflection lobe is multiplied with: metal and dielectric share one GGX lobe.
vec3 reflectionColor(Bsdf b, float cosine)
{
    vec3 metal = b.base_color + (1.0 - b.base_color) * schlick(cosine);
    return mix(dielectricFresnel(b, cosine), metal, b.metallic);
}

/// What is left for the layer below, diffuse and transmission together.
vec3 belowColor(Bsdf b, float cosine)
{
    return (1.0 - b.metallic) * (1.0 - maxComponent(dielectricFresnel(b, cosine))) * b.base_color;
}

/// Colour of the diffuse lobe before the dielectric layer above it takes its share; black where there is none.
vec3 diffuseColor(Bsdf b) { return (1.0 - b.metallic) * (1.0 - b.transmission) * b.base_color; }

/// Directional-hemispherical reflectance of the diffuse lobe. The layer's (1 - wo.h)^5 has no closed form over the
/// hemisphere: a cubic in wo's cosine, good to 1e-4.
vec3 diffuseReflectance(Bsdf b, float cosine)
{
    if (!hasFeature(kFeatureSpecular))
        return diffuseColor(b);
    float mean_rise = 0.0280436 + cosine * (-0.0772954 + cosine * (0.0747859 - 0.0255469 * cosine));
    return diffuseColor(b) * (1.0 - maxComponent(b.f0 + (vec3(b.f90) - b.f0) * mean_rise));
}

/// The same of the rough reflection lobe; 0 for a smooth one.
vec3 glossyReflectance(Bsdf b, float cosine)
{
    if (!hasFeature(kFeatureSpecular) || b.smooth_specular)
        return vec3(0.0);
    float roughness = sqrt(b.alpha);
    return clamp(mix(b.f0, b.base_color, b.metallic) * lobeScale(roughness, cosine) +
                     mix(b.f90, 1.0, b.metallic) * lobeBias(roughness, cosine),
                 0.0, 1.0);
}

/// Of all rough specular lobes, what passes through the surface included; of a smooth one only what passes.
vec3 specularReflectance(Bsdf b, float cosine) { return glossyReflectance(b, cosine) + belowColor(b, cosine) * b.transmission; }

struct LobeProbabilities { float reflection, diffuse, transmission; };

LobeProbabilities lobeProbabilities(Bsdf b, float cosine)
{
    float reflection = luminance(reflectionColor(b, cosine));
    float below = luminance(belowColor(b, cosine));
    LobeProbabilities p = LobeProbabilities(reflection, below * (1.0 - b.transmission), below * b.transmission);
    float sum = p.reflection + p.diffuse + p.transmission;
    float scale = sum > 0.0 ? 1.0 / sum : 0.0;
    return LobeProbabilities(p.reflection * scale, p.diffuse * scale, p.transmission * scale);
}

// ---- GGX (Walter et al. 2007) ----------------------------------------------------------------------------------------

float ggxDistribution(vec3 h, float alpha)
{
    float a2 = alpha * alpha;
    float d = h.z * h.z * (a2 - 1.0) + 1.0;
    return a2 / (kPi * d * d);
}

float ggxMasking(float cosine, float alpha) // Smith G1
{
    float c2 = cosine * cosine;
    return 2.0 / (1.0 + sqrt(1.0 + alpha * alpha * (1.0 - c2) / max(c2, 1e-12)));
}

/// A normal visible from wo (Heitz 2018, "Sampling the GGX Distribution of Visible Normals").
vec3 sampleVisibleNormal(vec3 wo, float alpha, vec2 u)
{
    vec3 v = normalize(vec3(alpha * wo.xy, wo.z));
    float length2 = dot(v.xy, v.xy);
    vec3 t1 = length2 > 0.0 ? vec3(-v.y, v.x, 0.0) * inversesqrt(length2) : vec3(1.0, 0.0, 0.0);
    vec3 t2 = cross(v, t1);
    float r = sqrt(u.x), phi = 2.0 * kPi * u.y;
    float x = r * cos(phi), y = r * sin(phi);
    float s = 0.5 * (1.0 + v.z);
    y = (1.0 - s) * sqrt(max(0.0, 1.0 - x * x)) + s * y;
    vec3 n = x * t1 + y * t2 + sqrt(max(0.0, 1.0 - x * x - y * y)) * v;
    return normalize(vec3(alpha * n.xy, max(1e-6, n.z)));
}

float visibleNormalPdf(vec3 wo, vec3 h, float alpha)
{
    return ggxDistribution(h, alpha) * ggxMasking(wo.z, alpha) * max(0.0, dot(wo, h)) / wo.z;
}

// ---- Evaluation --------------------------------------------------------------------------------------------------------

struct BsdfValue // towards one direction; the BSDF is the sum of both lobes
{
    vec3 diffuse;  // f, 1/sr
    vec3 specular; // f of reflection and transmission, 1/sr; 0 where they are delta
    float pdf;     // per steradian, with which sampleBsdf would choose the direction through any of them
};

/// GGX reflection, and a thin wall's transmission, which is the same lobe on the other side.
void addReflection(Bsdf b, LobeProbabilities p, vec3 wo, vec3 wi, inout BsdfValue value)
{
    bool reflected = wi.z > 0.0;
    vec3 mirrored = vec3(wi.xy, abs(wi.z));
    vec3 h = normalize(wo + mirrored);
    float cosine = dot(wo, h);
    float g = ggxMasking(wo.z, b.alpha) * ggxMasking(mirrored.z, b.alpha);
    float lobe = ggxDistribution(h, b.alpha) * g / (4.0 * wo.z * mirrored.z);
    value.specular = lobe * (reflected ? reflectionColor(b, cosine) : belowColor(b, cosine) * b.transmission);
    value.pdf += (reflected ? p.reflection : p.transmission) * visibleNormalPdf(wo, h, b.alpha) / (4.0 * cosine);
}

/// GGX refraction into what lies behind the surface.
void addRefraction(Bsdf b, LobeProbabilities p, vec3 wo, vec3 wi, inout BsdfValue value)
{
    vec3 h = normalize(wo + b.eta * wi);
    h = h.z < 0.0 ? -h : h;
    float cos_o = dot(wo, h), cos_i = dot(wi, h);
    if (cos_o <= 0.0 || cos_i >= 0.0)
        return;
    float denominator = square(cos_o + b.eta * cos_i);
    float g = ggxMasking(wo.z, b.alpha) * ggxMasking(-wi.z, b.alpha);
    // Walter et al. 2007, eq. 21, for radiance arriving from behind (eta^2 of eq. 21 cancels against the index ratio).
    value.specular = belowColor(b, cos_o) * b.transmission * ggxDistribution(h, b.alpha) * g * abs(cos_o * cos_i) /
                     (abs(wo.z * wi.z) * denominator);
    value.pdf = p.transmission * visibleNormalPdf(wo, h, b.alpha) * abs(cos_i) * b.eta * b.eta / denominator;
}

/// All lobes that are not delta.
BsdfValue evaluateBsdf(Bsdf b, vec3 wo, vec3 wi)
{
    BsdfValue value = BsdfValue(vec3(0.0), vec3(0.0), 0.0);
    if (wi.z == 0.0)
        return value;
    LobeProbabilities p = lobeProbabilities(b, wo.z);
    if (wi.z > 0.0)
    {
        float cosine = sqrt(max(0.0, 0.5 + 0.5 * dot(wo, wi))); // of the half vector
        value.diffuse = belowColor(b, cosine) * (1.0 - b.transmission) * kInvPi;
        value.pdf = p.diffuse * wi.z * kInvPi;
    }
    if (!hasFeature(kFeatureSpecular) || b.smooth_specular || wo.z <= 0.0)
        return value;
    if (wi.z > 0.0 || b.thin)
        addReflection(b, p, wo, wi, value);
    else if (hasFeature(kFeatureTransmission) && b.transmission > 0.0)
        addRefraction(b, p, wo, wi, value);
    return value;
}

// ---- Sampling ----------------------------------------------------------------------------------------------------------

BsdfSample deltaSample(Bsdf b, LobeProbabilities p, vec3 wo, bool reflect_it)
{
    if (reflect_it)
        return BsdfSample(vec3(-wo.xy, wo.z), reflectionColor(b, wo.z) / p.reflection, vec3(0.0), 0.0, false);
    vec3 weight = belowColor(b, wo.z) * b.transmission / p.transmission;
    if (b.thin)
        return BsdfSample(-wo, weight, vec3(0.0), 0.0, true);
    float sin2_t = (1.0 - wo.z * wo.z) / (b.eta * b.eta);
    if (sin2_t >= 1.0) // total internal reflection has no transmission; belowColor is 0 there
        return BsdfSample(-wo, vec3(0.0), vec3(0.0), 0.0, false);
    // Radiance is squeezed into a smaller solid angle in the denser medium: (n_viewer / n_behind)^2.
    return BsdfSample(vec3(-wo.xy / b.eta, -sqrt(1.0 - sin2_t)), weight / (b.eta * b.eta), vec3(0.0), 0.0, false);
}

/// Chooses a direction. @param choice picks the lobe, @param u the direction within it
BsdfSample sampleBsdf(Bsdf b, vec3 wo, float choice, vec2 u)
{
    const BsdfSample kAbsorbed = BsdfSample(vec3(0.0, 0.0, 1.0), vec3(0.0), vec3(0.0), 0.0, false);
    LobeProbabilities p = lobeProbabilities(b, wo.z);
    if (p.reflection + p.diffuse + p.transmission == 0.0)
        return kAbsorbed;
    bool diffuse = !hasFeature(kFeatureSpecular) || choice < p.diffuse;
    bool reflection = !diffuse && (choice < p.diffuse + p.reflection || p.transmission == 0.0);
    if (!diffuse && b.smooth_specular)
        return p.reflection == 0.0 && reflection ? kAbsorbed : deltaSample(b, p, wo, reflection);

    vec3 wi;
    if (diffuse)
    {
        wi = cosineDirection(u);
    }
    else
    {
        vec3 h = sampleVisibleNormal(wo, b.alpha, u);
        wi = reflect(-wo, h);
        if (reflection || b.thin)
        {
            if (wi.z <= 0.0)
                return kAbsorbed;
            wi.z = reflection ? wi.z : -wi.z;
        }
        else
        {
            wi = refract(-wo, h, 1.0 / b.eta);
            if (wi.z >= 0.0) // no refraction, or it comes out on the wrong side
                return kAbsorbed;
        }
    }
    BsdfValue f = evaluateBsdf(b, wo, wi);
    if (f.pdf <= 0.0)
        return kAbsorbed;
    vec3 diffuse_weight = f.diffuse * abs(wi.z) / f.pdf;
    return BsdfSample(wi, (f.diffuse + f.specular) * abs(wi.z) / f.pdf, diffuse_weight, f.pdf, false);
}

/// Whether any lobe can be evaluated for a given direction, that is: whether light sampling makes sense.
bool hasDensity(Bsdf b)
{
    return !b.smooth_specular || ((1.0 - b.metallic) * (1.0 - b.transmission) > 0.0 && b.base_color != vec3(0.0));
}

#endif
