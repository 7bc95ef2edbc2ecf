#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/lights.glsl"
#include "shaders/lib/path.glsl"

// One link of every specular chain: a ray that met a smooth mirror or dielectric goes on, reflected or refracted by
// chance; any other becomes its pixel's shading point, or ends in the sky. One thread per ray of the queue.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ChainParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Queue { QueueSize queue; };
layout(set = 1, binding = 1) uniform usamplerBuffer Rays;
layout(set = 1, binding = 2) uniform usamplerBuffer Hits;
layout(set = 1, binding = 3, scalar) buffer Points { ShadingPoint points[]; };
layout(set = 1, binding = 4, scalar) buffer Radiance { vec3 radiance[]; };
layout(set = 1, binding = 5, scalar) buffer NextQueue { QueueSize next_queue; };
layout(set = 1, binding = 6, scalar) writeonly buffer NextRays { Ray next_rays[]; };
layout(set = 1, binding = 7, scalar) writeonly buffer DiffusePoints { DiffusePoint diffuse_points[]; };
#include "shaders/lib/hit.glsl"
#include "shaders/lib/ray.glsl"

const float kAllMirror = 0.9999; // what reflects as much has nothing below it: the rest is rounding

/// ShadingPoint.mirror behind one more mirror.
uint mirrorAfter(uint mirror, vec3 normal) { return mirror == kNoMirror ? packNormal(normal) : kManyMirrors; }

/// At the first vertex the mirrored part of the light goes its own way, to the pixel's second point: what is seen in a pane and
/// what is seen through it are both there in every frame. @param random picks among mirrors
void split(Ray ray, PathVertex v, float scattered, float mirror, vec3 throughput, uint medium, float width, float random)
{
    LobeProbabilities p = lobeProbabilities(v.bsdf, v.wo);
    float reflection = v.bsdf.smooth_specular ? p.reflection : 0.0;
    bool coat = random * mirror >= reflection; // the last of the lobes
    BsdfSample next = sampleBsdf(v.bsdf, v.wo, coat ? 1.0 : scattered + random * mirror, vec2(0.5));
    vec3 wi = v.frame * next.wi;
    if (next.weight == vec3(0.0) || !sidesAgree(v.surface, wi, next.wi.z))
        return;
    uint second = ray.path + params.pixel_count;
    points[second].throughput = throughput * next.weight * mirror;
    points[second].slot = mediumAfter(v, next, medium);
    points[second].width = width;
    points[second].mirror = mirrorAfter(kNoMirror, v.surface.normal);
    next_rays[atomicAdd(next_queue.count, 1u)] = leavingRay(v.surface, wi, kInfinity, second);
}

/// What a chain's ray that met something does there. `point` and `diffuse` are updated where it is the shading point, and
/// `point` where the chain goes on: until it is finished its point holds throughput, width and mirrors so far and, in `slot`, the
/// medium that the ray is in. @return radiance that the surface itself sends along the ray
vec3 meetSurface(Ray ray, Hit hit, inout ShadingPoint point, inout DiffusePoint diffuse)
{
    vec3 direction = ray.direction;
    uint medium = point.slot;
    point.slot = kNone;
    point.width += params.spread * hit.t;
    PathVertex v = vertexAt(ray, hit, point.width);
    Surface s = v.surface;
    vec3 throughput = point.throughput * transmittanceTo(v, medium, hit.t);
    if (isUnlit(v))
        return throughput * v.material.base_color;
    vec3 light = emits(s) ? throughput * v.material.emission : vec3(0.0);

    Sampler sampler_ = vertexSampler(ray.path, params.depth, params.pixel_count, params.first_sample, params.seed);
    vec2 random = nextPair(sampler_);
    disperse(v, throughput, random.y);
    Bsdf b = v.bsdf;
    LobeProbabilities p = lobeProbabilities(b, v.wo);
    float scattered = p.diffuse + glossyProbability(b, p), mirror = mirrorProbability(b, p), rest = 1.0;
    if (hasFeature(kFeatureDeltaLobes) && params.splits != 0u && mirror > 0.0 && mirror < kAllMirror)
    {
        rest = 1.0 - mirror;
        split(ray, v, scattered, mirror, throughput, medium, point.width, random.x);
    }
    float choice = rest * random.x;
    if (!hasDeltaLobe(b) || choice < scattered)
    {
        throughput /= hasDeltaLobe(b) ? scattered / rest : 1.0;
        vec3 reflectance = throughput * diffuseReflectance(b, max(0.0, -dot(s.normal, direction)));
        point = ShadingPoint(s.position, hit.slot, direction, params.depth, throughput, hit.barycentrics, point.width,
                             s.back, point.mirror, v.material.base_color, packFinish(v.material.roughness, v.material.metallic));
        // Irradiance will be that of the smooth normal: even light over its hemisphere gives a bent one this much of it.
        reflectance *= 0.5 + 0.5 * dot(s.normal, s.smooth_normal);
        diffuse = DiffusePoint(s.position - min(clearance(s), s.back) * direction, unitToOctahedral(s.smooth_normal), reflectance);
        return light;
    }
    if (rest < 1.0 && b.smooth_specular) // what is left goes through
        choice += p.reflection;
    BsdfSample next = sampleBsdf(b, v.wo, choice, vec2(0.5));
    vec3 wi = v.frame * next.wi;
    if (params.depth >= params.depth_limit || next.weight == vec3(0.0) || !sidesAgree(s, wi, next.wi.z))
        return light;
    medium = mediumAfter(v, next, medium);
    point.throughput = throughput * next.weight * rest;
    point.slot = medium;
    if (next.wi.z > 0.0)
        point.mirror = mirrorAfter(point.mirror, s.normal);
    next_rays[atomicAdd(next_queue.count, 1u)] = leavingRay(s, wi, kInfinity, ray.path);
    return light;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= queue.count)
        return;
    Ray ray = loadRay(i);
    Hit hit = loadHit(i);
    ShadingPoint point =
        ShadingPoint(vec3(0.0), kNone, ray.direction, params.depth, vec3(1.0), vec2(0.0), params.width, 0.0, kNoMirror, vec3(0.0), 0u);
    if (params.depth == 0u)
        point.width += params.spread * length(ray.origin - params.eye); // the near plane is where it starts
    if (hasFeature(kFeatureDeltaLobes) && params.splits != 0u)
    {
        uint second = ray.path + params.pixel_count;
        points[second] =
            ShadingPoint(vec3(0.0), kNone, ray.direction, params.depth, vec3(0.0), vec2(0.0), params.width, 0.0, kNoMirror, vec3(0.0), 0u);
        diffuse_points[second] = DiffusePoint(vec3(0.0), vec2(0.0), vec3(0.0));
        radiance[second] = vec3(0.0);
    }
    vec3 before = vec3(0.0);
    if (params.depth > 0u)
    {
        point.throughput = points[ray.path].throughput;
        point.slot = points[ray.path].slot;
        point.width = points[ray.path].width;
        point.mirror = points[ray.path].mirror;
        before = radiance[ray.path];
    }
    DiffusePoint diffuse = DiffusePoint(vec3(0.0), vec2(0.0), vec3(0.0));
    vec3 light;
    if (hit.slot != kNone)
        light = meetSurface(ray, hit, point, diffuse);
    else
    {
        light = point.throughput * environmentRadiance(ray.direction);
        point.slot = kNone;
    }
    points[ray.path] = point;
    diffuse_points[ray.path] = diffuse;
    radiance[ray.path] = before + light;
}
