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
layout(set = 1, binding = 1, scalar) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 3, scalar) buffer Points { ShadingPoint points[]; };
layout(set = 1, binding = 4, scalar) buffer Radiance { vec3 radiance[]; };
layout(set = 1, binding = 5, scalar) buffer NextQueue { QueueSize next_queue; };
layout(set = 1, binding = 6, scalar) writeonly buffer NextRays { Ray next_rays[]; };
layout(set = 1, binding = 7, scalar) writeonly buffer DiffusePoints { DiffusePoint diffuse_points[]; };

// Until a chain is finished its point holds the throughput so far and, in `slot`, the medium the ray is in.
void finish(uint path, vec3 light)
{
    points[path].slot = kNone;
    diffuse_points[path].reflectance = vec3(0.0);
    if (params.depth == 0u)
        radiance[path] = light;
    else
        radiance[path] += light;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= queue.count)
        return;
    uint path = rays[i].path;
    vec3 direction = rays[i].direction;
    Hit hit = hits[i];
    vec3 throughput = params.depth == 0u ? vec3(1.0) : points[path].throughput;
    uint medium = params.depth == 0u ? kNone : points[path].slot;
    if (hit.slot == kNone)
    {
        finish(path, throughput * environmentRadiance(direction));
        return;
    }
    Surface s = surfaceAt(hit.slot, hit.barycentrics, direction);
    SurfaceMaterial m = materialAt(s);
    throughput *= mediumTransmittance(crossedMedium(medium, s, m), hit.t);
    bool unlit = (m.flags & kMaterialUnlit) != 0u;
    finish(path, throughput * (unlit ? m.base_color : emits(s) ? m.emission : vec3(0.0)));
    if (unlit)
        return;

    Bsdf b = bsdfAt(m, s.front);
    mat3 frame = frameAround(s.normal);
    vec3 wo = -direction * frame;
    Sampler sampler_ = vertexSampler(path, params.depth, params.pixel_count, params.first_sample, params.seed);
    LobeProbabilities p = lobeProbabilities(b, wo.z);
    float choice = nextPair(sampler_).x;
    if (!b.smooth_specular || choice < p.diffuse)
    {
        throughput /= b.smooth_specular ? p.diffuse : 1.0;
        points[path] = ShadingPoint(s.position, hit.slot, direction, params.depth, throughput, hit.barycentrics);
        vec3 reflectance = throughput * diffuseReflectance(b, max(0.0, -dot(s.normal, direction)));
        diffuse_points[path] = DiffusePoint(s.position, unitToOctahedral(s.smooth_normal), reflectance);
        return;
    }
    BsdfSample next = sampleBsdf(b, wo, choice, vec2(0.5));
    vec3 wi = frame * next.wi;
    if (params.depth >= params.depth_limit || next.weight == vec3(0.0) || !sidesAgree(s, wi, next.wi.z))
        return;
    if (next.wi.z < 0.0 && !next.passed)
        medium = s.front && enclosesMedium(s, m) ? s.material : kNone;
    points[path].throughput = throughput * next.weight;
    points[path].slot = medium;
    next_rays[atomicAdd(next_queue.count, 1u)] = leavingRay(s, wi, kInfinity, path);
}
