// One vertex of a gathering ray's path: at a surface that scatters it reads the light there; a mirror or glass continues it.
// The kernel defines `Incident lightAt(vec3 x, vec3 n, uint random)` before it includes this. Functions only.
#ifndef LIB_GATHER_LINK_GLSL
#define LIB_GATHER_LINK_GLSL
#include "shaders/gather/gather.h"
#include "shaders/lib/path.glsl"

const float kLeastAlpha = 0.25; // the sharpest lobe for which one direction may represent all incident light

/// The same with lobes wide enough for that.
Bsdf widened(Bsdf b)
{
    b.alpha = max(b.alpha, kLeastAlpha);
    b.stretched = max(b.stretched, kLeastAlpha);
    b.clearcoat_alpha = max(b.clearcoat_alpha, kLeastAlpha);
    return b;
}

/// Light of photons that a surface reflects back along a path (Jensen 1996).
vec3 reflectedLight(PathVertex v, Incident light)
{
    Bsdf b = v.bsdf, wide = widened(b);
    vec3 wi = -light.direction * v.frame;
    wi.z = max(wi.z, 0.05); // the shading normal of the photon's place was another
    BsdfValue f = evaluateBsdf(wide, v.wo, normalize(wi));
    vec3 kept = sharpestAlpha(b) >= kLeastAlpha ? vec3(1.0) : glossyReflectance(b, v.wo.z) / max(glossyReflectance(wide, v.wo.z), vec3(1e-6));
    return f.diffuse * light.irradiance + f.specular * kept * light.in_its_color;
}

struct GatherVertex
{
    vec3 radiance; // of the finished path; 0 while it continues
    bool goes_on;
    Ray next;
};

/// @param state of the path; updated where it goes on
/// @param count_emitters whether emitters and sky met through mirrors or glass count. From a glossy lobe they do; from the
/// diffuse one they are caustics. Met directly they are direct light: they never count.
GatherVertex shadeGatherVertex(Ray ray, Hit hit, inout GatherState state, Sampler sampler_, bool count_emitters)
{
    GatherVertex vertex = GatherVertex(vec3(0.0), false, ray);
    bool counts = count_emitters && state.specular > 0u;
    if (hit.slot == kNone)
    {
        if (counts)
            vertex.radiance = state.throughput * environmentRadiance(ray.direction);
        return vertex;
    }
    PathVertex v = vertexAt(ray, hit);
    Surface s = v.surface;
    if (isUnlit(v))
        return vertex;
    state.throughput *= transmittanceTo(v, state.medium, hit.t);
    if (counts && emits(s))
        vertex.radiance = state.throughput * v.material.emission;
    uvec2 bits = nextBits(sampler_);
    float choice = toUnitFloat(bits.x);
    disperse(v, state.throughput, toUnitFloat(hash(bits.y, 1u)));
    Bsdf b = v.bsdf;
    LobeProbabilities p = lobeProbabilities(b, v.wo);
    float scattered = p.diffuse + glossyProbability(b, p);
    if (!hasDeltaLobe(b) || choice < scattered)
    {
        vec3 reflected = reflectedLight(v, lightAt(s.position, s.geometric_normal, bits.y));
        if (isTranslucent(b))
            reflected += diffuseTransmittance(b, v.wo.z) * kInvPi * lightAt(s.position, -s.geometric_normal, bits.y).irradiance;
        vertex.radiance += state.throughput * reflected / (hasDeltaLobe(b) ? scattered : 1.0);
        return vertex;
    }
    BsdfSample next = sampleBsdf(b, v.wo, choice, vec2(0.5));
    vec3 wi = v.frame * next.wi;
    if (next.weight == vec3(0.0) || !sidesAgree(s, wi, next.wi.z))
        return vertex;
    state.medium = mediumAfter(v, next, state.medium);
    state.throughput *= next.weight;
    state.specular += uint(!next.passed);
    vertex.goes_on = true;
    vertex.next = leavingRay(s, wi, kInfinity, ray.path);
    return vertex;
}

#endif
