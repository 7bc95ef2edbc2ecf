// The BSDF of the layers of lib/bsdf/layers.glsl: what it is towards a direction, and directions chosen by it. Lambert
// reflection and transmission, sheen, GGX coat, reflection and refraction; the last three are deltas where they are smooth.
// Directions are local: z along the shading normal on the viewer's side, wo.z > 0 but for matter without specular lobes.
// Functions only.
#ifndef LIB_BSDF_GLSL
#define LIB_BSDF_GLSL
#include "shaders/lib/bsdf/layers.glsl"

struct LobeProbabilities { float diffuse, translucent, sheen, clearcoat, reflection, transmission; };

LobeProbabilities lobeProbabilities(Bsdf b, vec3 wo)
{
    float kept = covered(b, wo, wo);
    float passed = kept * luminance(belowColor(b, wo.z));
    LobeProbabilities p;
    p.diffuse = passed * reflectedShare(b);
    p.translucent = 0.0;
    if (isTranslucent(b))
        p.translucent = kept * passedShare(b, wo.z) * translucentShare(b) * luminance(b.diffuse_transmission_color);
    p.sheen = hasSheen(b) ? luminance(b.sheen_color) * sheenAlbedo(b.sheen_roughness, wo.z) : 0.0;
    p.clearcoat = hasClearcoat(b) ? clearcoatFresnel(b, clearcoatCosine(b, wo)) : 0.0;
    p.reflection = kept * luminance(reflectionColor(b, wo.z));
    p.transmission = passed * b.transmission;
    float sum = p.reflection + p.diffuse + p.transmission + p.translucent + p.sheen + p.clearcoat;
    float scale = sum > 0.0 ? 1.0 / sum : 0.0;
    return LobeProbabilities(p.diffuse * scale, p.translucent * scale, p.sheen * scale, p.clearcoat * scale, p.reflection * scale,
                             p.transmission * scale);
}

/// Probability of a lobe that is neither diffuse nor a delta.
float glossyProbability(Bsdf b, LobeProbabilities p)
{
    return p.translucent + p.sheen + (b.smooth_specular ? 0.0 : p.reflection + p.transmission) +
           (hasClearcoat(b) && !b.smooth_clearcoat ? p.clearcoat : 0.0);
}

bool hasDeltaLobe(Bsdf b) { return b.smooth_specular || (hasClearcoat(b) && b.smooth_clearcoat); }

/// Of the delta lobes that reflect.
float mirrorProbability(Bsdf b, LobeProbabilities p)
{
    return (b.smooth_specular ? p.reflection : 0.0) + (hasClearcoat(b) && b.smooth_clearcoat ? p.clearcoat : 0.0);
}

// ---- Evaluation --------------------------------------------------------------------------------------------------------

struct BsdfValue // towards one direction; the BSDF is the sum of both parts
{
    vec3 diffuse;  // f of Lambert reflection, 1/sr
    vec3 specular; // f of all other lobes, 1/sr; 0 where they are delta
    float pdf;     // per steradian, with which sampleBsdf would choose the direction through any of them
};

/// GGX reflection, and a thin wall's transmission, which is the same lobe on the other side.
void addReflection(Bsdf b, LobeProbabilities p, vec3 wo, vec3 wi, inout BsdfValue value)
{
    bool reflected = wi.z > 0.0;
    vec3 mirrored = vec3(wi.xy, abs(wi.z));
    vec3 h = normalize(wo + mirrored);
    float cosine = dot(wo, h);
    float g = ggxMasking(wo, alphas(b)) * ggxMasking(mirrored, alphas(b));
    float lobe = ggxDistribution(h, alphas(b)) * g / (4.0 * wo.z * mirrored.z);
    value.specular += covered(b, wo, wi) * lobe * (reflected ? reflectionColor(b, cosine) : belowColor(b, cosine) * b.transmission);
    value.pdf += (reflected ? p.reflection : p.transmission) * visibleNormalPdf(wo, h, alphas(b)) / (4.0 * cosine);
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
    float g = ggxMasking(wo, alphas(b)) * ggxMasking(-wi, alphas(b));
    // Walter et al. 2007, eq. 21, for radiance arriving from behind (eta^2 of eq. 21 cancels against the index ratio).
    value.specular += covered(b, wo, wi) * b.dispersed * belowColor(b, cos_o) * b.transmission * ggxDistribution(h, alphas(b)) * g *
                      abs(cos_o * cos_i) / (abs(wo.z * wi.z) * denominator);
    value.pdf += p.transmission * visibleNormalPdf(wo, h, alphas(b)) * abs(cos_i) * b.eta * b.eta / denominator;
}

/// Lambert on the far side, under the same dielectric layer: by the half vector of the mirrored direction.
void addTranslucence(Bsdf b, LobeProbabilities p, vec3 wo, vec3 wi, inout BsdfValue value)
{
    float cosine = sqrt(max(0.0, 0.5 + 0.5 * dot(wo, vec3(wi.xy, -wi.z))));
    value.specular += covered(b, wo, wi) * passedShare(b, cosine) * translucentShare(b) * b.diffuse_transmission_color * kInvPi;
    value.pdf += p.translucent * -wi.z * kInvPi;
}

void addSheen(Bsdf b, LobeProbabilities p, vec3 wo, vec3 wi, inout BsdfValue value)
{
    value.specular += b.sheen_color * sheenLobe(b.sheen_roughness, wo, wi);
    if (hasClearcoat(b))
        value.specular *= 1.0 - max(clearcoatAlbedo(b, clearcoatCosine(b, wo)), clearcoatAlbedo(b, clearcoatCosine(b, wi)));
    value.pdf += p.sheen * 0.5 * kInvPi; // directions of equal solid angle
}

void addClearcoat(Bsdf b, LobeProbabilities p, vec3 wo, vec3 wi, inout BsdfValue value)
{
    mat3 frame = clearcoatFrame(b);
    vec3 v = wo * frame, l = wi * frame;
    if (v.z <= 0.0 || l.z <= 0.0)
        return;
    vec2 width = vec2(b.clearcoat_alpha);
    vec3 h = normalize(v + l);
    float cosine = dot(v, h), g = ggxMasking(v, width) * ggxMasking(l, width);
    // The coat's own cosine to the light, in the place of the base's that callers multiply with.
    value.specular += clearcoatFresnel(b, cosine) * ggxDistribution(h, width) * g / (4.0 * v.z * max(wi.z, 1e-4));
    value.pdf += p.clearcoat * visibleNormalPdf(v, h, width) / (4.0 * cosine);
}

/// All lobes that are not delta.
BsdfValue evaluateBsdf(Bsdf b, vec3 wo, vec3 wi)
{
    BsdfValue value = BsdfValue(vec3(0.0), vec3(0.0), 0.0);
    if (wi.z == 0.0)
        return value;
    LobeProbabilities p = lobeProbabilities(b, wo);
    if (wi.z > 0.0)
    {
        float cosine = sqrt(max(0.0, 0.5 + 0.5 * dot(wo, wi))); // of the half vector
        value.diffuse = covered(b, wo, wi) * belowColor(b, cosine) * reflectedShare(b) * kInvPi;
        value.pdf = p.diffuse * wi.z * kInvPi;
    }
    else if (isTranslucent(b))
        addTranslucence(b, p, wo, wi, value);
    if (!hasFeature(kFeatureSpecular) || wo.z <= 0.0)
        return value;
    if (hasSheen(b) && wi.z > 0.0)
        addSheen(b, p, wo, wi, value);
    if (hasClearcoat(b) && !b.smooth_clearcoat && wi.z > 0.0)
        addClearcoat(b, p, wo, wi, value);
    if (b.smooth_specular)
        return value;
    if (wi.z > 0.0 || (b.thin && b.transmission > 0.0))
        addReflection(b, p, wo, wi, value);
    else if (hasFeature(kFeatureTransmission) && b.transmission > 0.0)
        addRefraction(b, p, wo, wi, value);
    return value;
}

// ---- Sampling ----------------------------------------------------------------------------------------------------------

struct BsdfSample
{
    vec3 wi;     // local; below the surface for transmission
    vec3 weight; // f |cos| / pdf; zero: absorbed
    vec3 diffuse_weight; // the diffuse lobe's part of it
    float pdf;   // per steradian, 0 for a delta lobe
    bool passed; // went straight through a thin smooth wall: not a scattering event
    bool refracted; // into matter of another index
};

const BsdfSample kAbsorbed = BsdfSample(vec3(0.0, 0.0, 1.0), vec3(0.0), vec3(0.0), 0.0, false, false);

const uint kDiffuseLobe = 0u, kTranslucentLobe = 1u, kSheenLobe = 2u, kClearcoatLobe = 3u, kReflectionLobe = 4u, kTransmissionLobe = 5u;

/// By intervals of `choice`: the diffuse lobe, then the glossy ones, then the deltas.
uint chooseLobe(Bsdf b, LobeProbabilities p, float choice)
{
    if (!hasFeature(kFeatureSpecular) || choice < p.diffuse)
        return kDiffuseLobe;
    float end = p.diffuse;
    if (isTranslucent(b) && choice < (end += p.translucent))
        return kTranslucentLobe;
    if (hasSheen(b) && choice < (end += p.sheen))
        return kSheenLobe;
    bool coated = hasClearcoat(b);
    if (coated && !b.smooth_clearcoat && choice < (end += p.clearcoat))
        return kClearcoatLobe;
    coated = coated && b.smooth_clearcoat;
    end += p.reflection;
    if (choice < end || (p.transmission == 0.0 && !coated))
        return kReflectionLobe;
    return coated && choice >= end + p.transmission ? kClearcoatLobe : kTransmissionLobe;
}

BsdfSample mirrorSample(vec3 wi, vec3 weight) { return BsdfSample(wi, weight, vec3(0.0), 0.0, false, false); }

BsdfSample clearcoatMirror(Bsdf b, LobeProbabilities p, vec3 wo)
{
    mat3 frame = clearcoatFrame(b);
    vec3 v = wo * frame, wi = frame * vec3(-v.xy, v.z);
    if (v.z <= 0.0 || wi.z <= 0.0 || p.clearcoat == 0.0)
        return kAbsorbed;
    return mirrorSample(wi, vec3(clearcoatFresnel(b, v.z) / p.clearcoat));
}

/// Of a smooth surface.
BsdfSample deltaSample(Bsdf b, LobeProbabilities p, vec3 wo, bool reflect_it)
{
    float kept = covered(b, wo, wo);
    if (reflect_it)
        return p.reflection == 0.0 ? kAbsorbed : mirrorSample(vec3(-wo.xy, wo.z), kept * reflectionColor(b, wo.z) / p.reflection);
    vec3 weight = kept * belowColor(b, wo.z) * b.transmission / p.transmission;
    if (b.thin)
        return BsdfSample(-wo, weight, vec3(0.0), 0.0, true, false);
    float sin2_t = (1.0 - wo.z * wo.z) / (b.eta * b.eta);
    if (sin2_t >= 1.0) // total internal reflection has no transmission; belowColor is 0 there
        return kAbsorbed;
    // Radiance is squeezed into a smaller solid angle in the denser medium: (n_viewer / n_behind)^2.
    return BsdfSample(vec3(-wo.xy / b.eta, -sqrt(1.0 - sin2_t)), b.dispersed * weight / (b.eta * b.eta), vec3(0.0), 0.0, false, true);
}

/// A direction of the lobe, which is no delta. @return z is 0 where there is none
vec3 sampleLobe(Bsdf b, uint lobe, vec3 wo, vec2 u)
{
    const vec3 kNowhere = vec3(1.0, 0.0, 0.0);
    if (lobe == kDiffuseLobe)
        return cosineDirection(u);
    if (lobe == kTranslucentLobe)
        return -cosineDirection(u);
    if (lobe == kSheenLobe)
    {
        float r = sqrt(max(0.0, 1.0 - u.x * u.x)), phi = 2.0 * kPi * u.y;
        return vec3(r * cos(phi), r * sin(phi), u.x);
    }
    if (lobe == kClearcoatLobe)
    {
        mat3 frame = clearcoatFrame(b);
        vec3 v = wo * frame;
        vec3 wi = v.z > 0.0 ? frame * reflect(-v, sampleVisibleNormal(v, vec2(b.clearcoat_alpha), u)) : kNowhere;
        return wi.z > 0.0 ? wi : kNowhere;
    }
    vec3 h = sampleVisibleNormal(wo, alphas(b), u);
    vec3 wi = reflect(-wo, h);
    if (lobe == kReflectionLobe || b.thin)
        return wi.z <= 0.0 ? kNowhere : vec3(wi.xy, lobe == kReflectionLobe ? wi.z : -wi.z);
    wi = refract(-wo, h, 1.0 / b.eta);
    return wi.z < 0.0 ? wi : kNowhere; // no refraction, or it comes out on the wrong side
}

/// Chooses a direction. @param choice picks the lobe, @param u the direction within it
BsdfSample sampleBsdf(Bsdf b, vec3 wo, float choice, vec2 u)
{
    LobeProbabilities p = lobeProbabilities(b, wo);
    if (p.reflection + p.diffuse + p.transmission + p.translucent + p.sheen + p.clearcoat == 0.0)
        return kAbsorbed;
    uint lobe = chooseLobe(b, p, choice);
    if (lobe == kClearcoatLobe && b.smooth_clearcoat)
        return clearcoatMirror(b, p, wo);
    if (lobe >= kReflectionLobe && b.smooth_specular)
        return deltaSample(b, p, wo, lobe == kReflectionLobe);
    vec3 wi = sampleLobe(b, lobe, wo, u);
    if (wi.z == 0.0)
        return kAbsorbed;
    BsdfValue f = evaluateBsdf(b, wo, wi);
    if (f.pdf <= 0.0)
        return kAbsorbed;
    vec3 diffuse_weight = f.diffuse * abs(wi.z) / f.pdf;
    return BsdfSample(wi, (f.diffuse + f.specular) * abs(wi.z) / f.pdf, diffuse_weight, f.pdf, false,
                      lobe == kTransmissionLobe && !b.thin);
}

#endif
