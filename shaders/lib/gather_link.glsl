// One link of a gathering ray's path: at a surface that scatters it reads the light there; a mirror or glass sends it on.
// The kernel defines `Incident lightAt(vec3 x, vec3 n, uint random)` before it includes this. Functions only.
#ifndef LIB_GATHER_LINK_GLSL
#define LIB_GATHER_LINK_GLSL
#include "shaders/gather/gather.h"
#include "shaders/lib/path.glsl"

const float kLeastAlpha = 0.25; // one direction stands for all that light comes from: a lobe no sharper than that

/// What a surface sends towards wo of the light that photons brought (Jensen 1996).
vec3 reflectedLight(Bsdf b, mat3 frame, vec3 wo, Incident light)
{
    vec3 wi = -light.direction * frame;
    wi.z = max(wi.z, 0.05); // the shading normal of the photon's place was another
    Bsdf wide = b;
    wide.alpha = max(b.alpha, kLeastAlpha);
    BsdfValue f = evaluateBsdf(wide, wo, normalize(wi));
    vec3 kept = wide.alpha == b.alpha ? vec3(1.0) : glossyReflectance(b, wo.z) / max(glossyReflectance(wide, wo.z), vec3(1e-6));
    return f.diffuse * light.irradiance + f.specular * kept * light.in_its_color;
}

struct Link
{
    vec3 radiance; // that the path brings home; 0 while it goes on
    bool goes_on;
    Ray next;
};

/// @param state of the path; updated where it goes on
/// @param count_emitters whether emitters and sky met through mirrors or glass count. From a glossy lobe they do; from the
/// diffuse one they are caustics. Met directly they are direct light: they never count.
Link followLink(Ray ray, Hit hit, inout GatherState state, Sampler sampler_, bool count_emitters)
{
    Link link = Link(vec3(0.0), false, ray);
    bool counts = count_emitters && state.specular > 0u;
    if (hit.slot == kNone)
    {
        if (counts)
            link.radiance = state.throughput * environmentRadiance(ray.direction);
        return link;
    }
    Surface s = surfaceAt(ray, hit);
    SurfaceMaterial m = materialAt(s);
    if ((m.flags & kMaterialUnlit) != 0u)
        return link;
    state.throughput *= mediumTransmittance(crossedMedium(state.medium, s, m), hit.t);
    if (counts && emits(s))
        link.radiance = state.throughput * m.emission;
    Bsdf b = bsdfAt(m, s.front);
    mat3 frame = frameAround(s.normal);
    vec3 wo = -ray.direction * frame;
    LobeProbabilities p = lobeProbabilities(b, wo.z);
    uvec2 bits = nextBits(sampler_);
    float choice = toUnitFloat(bits.x);
    if (!b.smooth_specular || choice < p.diffuse)
    {
        Incident light = lightAt(s.position, s.geometric_normal, bits.y);
        link.radiance += state.throughput * reflectedLight(b, frame, wo, light) / (b.smooth_specular ? p.diffuse : 1.0);
        return link;
    }
    BsdfSample next = sampleBsdf(b, wo, choice, vec2(0.5));
    vec3 wi = frame * next.wi;
    if (next.weight == vec3(0.0) || !sidesAgree(s, wi, next.wi.z))
        return link;
    if (next.wi.z < 0.0 && !next.passed)
        state.medium = s.front && enclosesMedium(s, m) ? s.material : kNone;
    state.throughput *= next.weight;
    state.specular += uint(!next.passed);
    link.goes_on = true;
    link.next = leavingRay(s, wi, kInfinity, ray.path);
    return link;
}

#endif
