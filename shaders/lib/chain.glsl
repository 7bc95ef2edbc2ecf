// Specular chains from the camera: a ray that meets a smooth mirror or dielectric goes on, reflected or refracted by chance; any
// other ends at its pixel's shading point, or in the sky. The kernel declares `ChainParams params` before it includes this.
// Functions only.
#ifndef LIB_CHAIN_GLSL
#define LIB_CHAIN_GLSL
#include "shaders/lib/lights.glsl"
#include "shaders/lib/path.glsl"

const float kAllMirror = 0.9999; // what reflects as much has nothing below it: the rest is rounding

/// Until a chain is finished, its point holds throughput, width and mirrors so far and, in `slot`, the medium that the ray is in.
struct ChainVertex
{
    ShadingPoint point;
    DiffusePoint diffuse;
    vec3 light;   // radiance that surfaces themselves, or the sky, send along the chain
    bool goes_on; // by `next`
    Ray next;
    bool splits; // there is a second chain: that of the light mirrored at the first vertex
    ShadingPoint second;
    Ray second_next;
};

ShadingPoint beginPoint(vec3 direction, uint depth, vec3 throughput, float width)
{
    return ShadingPoint(vec3(0.0), kNone, direction, depth, throughput, vec2(0.0), width, 0.0, kNoMirror, vec3(0.0), 0u);
}
const DiffusePoint kNoDiffusePoint = DiffusePoint(vec3(0.0), vec2(0.0), vec3(0.0));

uint pixelCount() { return params.camera.width * params.camera.height; }

/// ShadingPoint.mirror behind one more mirror.
uint mirrorAfter(uint mirror, vec3 normal) { return mirror == kNoMirror ? packNormal(normal) : kManyMirrors; }

/// At the first vertex the mirrored part of the light goes its own way, to the pixel's second point: what is seen in a pane and
/// what is seen through it are both there in every frame. @param random picks among mirrors
void split(inout ChainVertex c, Ray ray, PathVertex v, float scattered, float mirror, vec3 throughput, uint medium, float random)
{
    LobeProbabilities p = lobeProbabilities(v.bsdf, v.wo);
    float reflection = v.bsdf.smooth_specular ? p.reflection : 0.0;
    bool coat = random * mirror >= reflection; // the last of the lobes
    BsdfSample next = sampleBsdf(v.bsdf, v.wo, coat ? 1.0 : scattered + random * mirror, vec2(0.5));
    vec3 wi = v.frame * next.wi;
    if (next.weight == vec3(0.0) || !sidesAgree(v.surface, wi, next.wi.z))
        return;
    c.second.throughput = throughput * next.weight * mirror;
    c.second.slot = mediumAfter(v, next, medium);
    c.second.width = c.point.width;
    c.second.mirror = mirrorAfter(kNoMirror, v.surface.normal);
    c.splits = true;
    c.second_next = leavingRay(v.surface, wi, kInfinity, ray.path + pixelCount());
}

/// What a chain's ray that met something does there. @param depth specular events before, @param splits whether it may
void meetSurface(inout ChainVertex c, Ray ray, Hit hit, uint depth, bool splits)
{
    vec3 direction = ray.direction;
    uint medium = c.point.slot;
    c.point.slot = kNone;
    c.point.width += params.spread * hit.t;
    PathVertex v = vertexAt(ray, hit, c.point.width);
    Surface s = v.surface;
    vec3 throughput = c.point.throughput * transmittanceTo(v, medium, hit.t);
    if (isUnlit(v))
    {
        c.light += throughput * v.material.base_color;
        return;
    }
    if (emits(s))
        c.light += throughput * v.material.emission;

    Sampler sampler_ = vertexSampler(ray.path, depth, pixelCount(), params.camera.first_sample, params.camera.seed);
    vec2 random = nextPair(sampler_);
    disperse(v, throughput, random.y);
    Bsdf b = v.bsdf;
    LobeProbabilities p = lobeProbabilities(b, v.wo);
    float scattered = p.diffuse + glossyProbability(b, p), mirror = mirrorProbability(b, p), rest = 1.0;
    if (hasFeature(kFeatureDeltaLobes) && splits && mirror > 0.0 && mirror < kAllMirror)
    {
        rest = 1.0 - mirror;
        split(c, ray, v, scattered, mirror, throughput, medium, random.x);
    }
    float choice = rest * random.x;
    if (!hasDeltaLobe(b) || choice < scattered)
    {
        throughput /= hasDeltaLobe(b) ? scattered / rest : 1.0;
        vec3 reflectance = throughput * diffuseReflectance(b, max(0.0, -dot(s.normal, direction)));
        c.point = ShadingPoint(s.position, hit.slot, direction, depth, throughput, hit.barycentrics, c.point.width, s.back,
                               c.point.mirror, v.material.base_color, packFinish(v.material.roughness, v.material.metallic));
        // Irradiance will be that of the smooth normal: even light over its hemisphere gives a bent one this much of it.
        reflectance *= 0.5 + 0.5 * dot(s.normal, s.smooth_normal);
        c.diffuse = DiffusePoint(s.position - min(clearance(s), s.back) * direction, unitToOctahedral(s.smooth_normal), reflectance);
        return;
    }
    if (rest < 1.0 && b.smooth_specular) // what is left goes through
        choice += p.reflection;
    BsdfSample next = sampleBsdf(b, v.wo, choice, vec2(0.5));
    vec3 wi = v.frame * next.wi;
    if (depth >= params.depth_limit || next.weight == vec3(0.0) || !sidesAgree(s, wi, next.wi.z))
        return;
    c.point.throughput = throughput * next.weight * rest;
    c.point.slot = mediumAfter(v, next, medium);
    if (next.wi.z > 0.0)
        c.point.mirror = mirrorAfter(c.point.mirror, s.normal);
    c.goes_on = true;
    c.next = leavingRay(s, wi, kInfinity, ray.path);
}

/// One vertex of a chain: updates all of `c`.
void chainVertex(inout ChainVertex c, Ray ray, Hit hit, uint depth, bool splits)
{
    c.goes_on = c.splits = false;
    if (hit.slot != kNone)
        meetSurface(c, ray, hit, depth, splits);
    else
    {
        c.light += c.point.throughput * environmentRadiance(ray.direction);
        c.point.slot = kNone;
    }
}

#endif
