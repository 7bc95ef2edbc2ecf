// One vertex of a gathering or glossy ray's path: at a surface that scatters it reads the light there; a mirror or glass continues it.
// The kernel defines `Incident lightAt(vec3 x, vec3 n, uint random)` before it includes this. Functions only.
#ifndef LIB_GATHER_VERTEX_GLSL
#define LIB_GATHER_VERTEX_GLSL
#include "shaders/gather/gather.h"
#include "shaders/lib/path.glsl"
#include "shaders/lib/trace.glsl"

const float kLeastAlpha = 0.25; // the sharpest lobe for which one direction may represent all incident light

/// The same with lobes wide enough for that.
Bsdf widened(Bsdf b)
{
    b.alpha = max(b.alpha, kLeastAlpha);
    b.stretched = max(b.stretched, kLeastAlpha);
    b.clearcoat_alpha = max(b.clearcoat_alpha, kLeastAlpha);
    return b;
}

/// Whether light passes by a rough lobe.
bool isFrosted(Bsdf b) { return hasFeature(kFeatureTransmission) && b.transmission > 0.0 && !b.smooth_specular; }

/// Light of photons that a surface scatters back along a path (Jensen 1996).
/// @param side of the surface on which they fell: 1 where the path is, -1 behind
vec3 scatteredLight(PathVertex v, Incident light, float side)
{
    Bsdf b = v.bsdf, wide = widened(b);
    vec3 wi = -light.direction * v.frame;
    wi.z = side * max(side * wi.z, 0.05); // the shading normal of the photon's place was another
    if (side < 0.0)
        wide.diffuse_transmission = 0.0; // Lambert transmission is not by one direction: below
    BsdfValue f = evaluateBsdf(wide, v.wo, normalize(wi));
    vec3 kept = vec3(1.0), lambertian = f.diffuse;
    if (side < 0.0)
        lambertian = isTranslucent(b) ? diffuseTransmittance(b, v.wo.z) * kInvPi : vec3(0.0);
    else if (sharpestAlpha(b) < kLeastAlpha)
        kept = glossyReflectance(b, v.wo.z) / max(glossyReflectance(wide, v.wo.z), vec3(1e-6));
    return lambertian * light.irradiance + f.specular * kept * light.in_its_color;
}

const uint kGatherDimensions = 2u + kLightPairs; // pairs of the sampler that a vertex uses

/// Of a path from a sample or pixel, at its vertex number `depth`.
Sampler gatherSampler(GatherParams params, uint path, uint depth)
{
    uint origin = path / params.ray_count;
    return Sampler(hash(params.seed, origin), path - origin * params.ray_count, 1u + depth * kGatherDimensions);
}

/// A path's way through the last frosted glass, where a light was sampled, too: both count by multiple importance sampling.
struct Passage
{
    float pdf;       // per steradian, of the direction in which it left; 0: there was none since the last mirror
    float travelled; // metres since
};
const Passage kNoPassage = Passage(0.0, 0.0);

/// Direct light that comes through frosted glass: of one light. @param passing probability that the path goes on through it
vec3 lightThrough(PathVertex v, float passing, inout Sampler sampler_)
{
    Surface s = v.surface;
    LightSample light = sampleLight(s.position, sampler_);
    vec3 wi = light.wi * v.frame;
    if (light.weight == vec3(0.0) || wi.z >= 0.0 || !sidesAgree(s, light.wi, wi.z))
        return vec3(0.0);
    BsdfValue f = evaluateBsdf(v.bsdf, v.wo, wi);
    if (f.specular == vec3(0.0))
        return vec3(0.0);
    vec3 carried = f.specular * -wi.z * light.weight;
    if (light.pdf > 0.0)
        carried *= misWeight(light.pdf, f.pdf / max(passing, 1e-6));
    Ray ray = shadowRay(s, light, 0u);
    return carried * transmittance(ray.origin, ray.direction, ray.t_max);
}

/// The weight of an emitter that the path meets.
float weightOfEmitter(Passage passage, Surface s)
{
    uint light = loadTriangle(s.triangle).light;
    if (!hasFeature(kFeatureTransmission) || passage.pdf == 0.0 || light == kNone)
        return 1.0;
    return misWeight(passage.pdf, trianglePdf(light, s.area, passage.travelled, abs(dot(s.geometric_normal, s.direction))));
}

struct GatherVertex
{
    vec3 radiance; // of the finished path; 0 while it continues
    bool goes_on;
    Ray next;
};

/// @param state of the path; updated where it goes on
/// @param glossy whether the path left a glossy lobe: emitters and sky met through mirrors or glass then count, and it goes on through
/// frosted glass. From the diffuse lobe the former are caustics, and the latter reads the light behind it. Emitters met
/// directly are direct light: they never count.
GatherVertex shadeGatherVertex(Ray ray, Hit hit, inout GatherState state, inout Passage passage, Sampler sampler_, bool glossy)
{
    GatherVertex vertex = GatherVertex(vec3(0.0), false, ray);
    bool counts = glossy && state.specular > 0u;
    if (hit.slot == kNone)
    {
        if (counts)
            vertex.radiance = state.throughput * environmentRadiance(ray.direction);
        if (counts && hasFeature(kFeatureTransmission) && passage.pdf > 0.0)
            vertex.radiance *= misWeight(passage.pdf, environmentPdf(ray.direction));
        return vertex;
    }
    PathVertex v = vertexAt(ray, hit);
    Surface s = v.surface;
    if (isUnlit(v))
        return vertex;
    state.throughput *= transmittanceTo(v, state.medium, hit.t);
    passage.travelled += hit.t;
    if (counts && emits(s))
        vertex.radiance = state.throughput * v.material.emission * weightOfEmitter(passage, s);
    uvec2 bits = nextBits(sampler_);
    float choice = toUnitFloat(bits.x);
    disperse(v, state.throughput, toUnitFloat(hash(bits.y, 1u)));
    Bsdf b = v.bsdf;
    LobeProbabilities p = lobeProbabilities(b, v.wo);
    float scattered = p.diffuse + glossyProbability(b, p), read = hasDeltaLobe(b) ? scattered : 1.0;
    vec2 within = vec2(0.5);
    bool frosted = isFrosted(b), follows = glossy && frosted && !isTranslucent(b);
    if (follows) // and reads all but that lobe: at the angle of total reflection few chances to do so would be very bright
    {
        within = nextPair(sampler_);
        vertex.radiance += state.throughput * lightThrough(v, 1.0 - scattered + p.transmission, sampler_);
        read = 1.0;
    }
    if (read == 1.0 || choice < read) // always, where the kernel's constants leave nothing to follow
    {
        bool passes = isTranslucent(b) || (frosted && !follows);
        vec3 light = vec3(0.0);
        float side = 1.0;
        do
        {
            light += scatteredLight(v, lightAt(s.position, side * s.geometric_normal, bits.y), side);
            side -= 2.0;
        } while (side == -1.0 && passes);
        vertex.radiance += state.throughput * light / read;
        scattered -= p.transmission;
        if (!follows || scattered >= 1.0)
            return vertex;
        state.throughput *= 1.0 - scattered;
        choice = mix(scattered, 1.0, choice);
    }
    BsdfSample next = sampleBsdf(b, v.wo, choice, within);
    vec3 wi = v.frame * next.wi;
    if (next.weight == vec3(0.0) || !sidesAgree(s, wi, next.wi.z))
        return vertex;
    state.medium = mediumAfter(v, next, state.medium);
    state.throughput *= next.weight;
    state.specular += uint(!next.passed);
    if (!next.passed)
        passage = Passage(next.pdf / max(1.0 - scattered, 1e-6), 0.0);
    vertex.goes_on = true;
    vertex.next = leavingRay(s, wi, kInfinity, ray.path);
    return vertex;
}

#endif
