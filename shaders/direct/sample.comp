#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/direct/direct.h"
#include "shaders/lib/tile.glsl"
#include "shaders/lib/trace.glsl"
#include "shaders/lib/unshadowed.glsl"

// Samples direct light at every shading point: a shadow ray to a light of the group, or one to each set of its clusters
// (survey.h), and, once for all groups, a BSDF-sampled ray that may end on an emitter (emitted.comp weights it). The light is
// chosen among candidates from all clusters of the set, with probability proportional to its contribution (Talbot et al. 2005,
// "Importance Resampling for Global Illumination"). One thread per point.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { DirectParams params; };

layout(set = 1, binding = 0) uniform usamplerBuffer Points;
layout(set = 1, binding = 1, scalar) buffer Radiance { vec3 radiance[]; };
layout(set = 1, binding = 2, scalar) buffer EmitterQueue { QueueSize emitter_queue; };
layout(set = 1, binding = 3, scalar) writeonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer EmitterRays { EmitterRay emitter_rays[]; };
layout(set = 1, binding = 5) uniform usamplerBuffer Picks;
layout(set = 1, binding = 6) uniform usamplerBuffer Clusters;
layout(set = 1, binding = 7, scalar) readonly buffer Tiles { TileLights tiles[]; };
layout(set = 1, binding = 8, scalar) buffer ShadowCount { QueueSize shadow_count; };

#include "shaders/lib/light_cluster.glsl"
#include "shaders/lib/point.glsl"

layout(constant_id = 3) const bool kKnowsSeen = false; // the group has several clusters, of which tiles know what they see

layout(constant_id = 4) const bool kCountsRays = false; // for measurements

const float kRestShare = 0.25; // of the blocks of pixels that send a ray to what is not seen around, where something is
const uint kBlock = 32u;       // threads, of neighbouring pixels (lib/tile.glsl)

/// The fraction of a cluster's light that is seen around.
float visibleOf(uint tile, uint cluster)
{
    return float(tiles[tile].visible[cluster / 4u] >> (8u * (cluster % 4u)) & 255u) * (1.0 / 255.0);
}

/// A shadow ray to one of the candidates of some clusters. They are chosen by the light that arrives around where there are more
/// clusters than candidates, and where candidates of one cluster differ. @param clusters a bit each; none: radiance is 0
ShadowRay sampleSet(uint set, uint clusters, PathVertex v, uint path, uint depth, uint index, uint tile, float draw)
{
    ShadowRay result = ShadowRay(Ray(vec3(0.0), 0.0, vec3(0.0), path), vec3(0.0), 0.0);
    if (clusters == 0u)
        return result;
    uint most = params.candidate_count, cluster_count = uint(bitCount(clusters)), few = (most + 1u) / 2u;
    if (kKnowsSeen && params.repeats != 0u && (set == kRestLights || (set == kSeenLights && cluster_count >= few)))
        most = few; // as good as more: clusters are stratified, and chance decides whether the ray arrives
    bool all = params.repeats == 0u && cluster_count <= most;
    uint count = all ? cluster_count : most;
    float turn = toUnitFloat(hash(hash(path, index), params.light_seed + set));
    LightSample chosen = kNoLight;
    vec3 carried = vec3(0.0);
    float sum = 0.0, chosen_weight = 0.0, begin = 0.0;
    uint cluster = uint(findLSB(clusters)), last = uint(findMSB(clusters));
    float end = !kKnowsSeen || all ? 1.0 / float(cluster_count) : tiles[tile].ends[cluster];
    for (uint k = 0u;;) // tests at its end: see lib/bvh.glsl why
    {
        float at = (float(k) + turn) / float(count);
        if (at >= end && cluster != last)
            do
            {
                clusters &= clusters - 1u;
                cluster = uint(findLSB(clusters));
                begin = end;
                end = !kKnowsSeen || all ? begin + 1.0 / float(cluster_count) : tiles[tile].ends[cluster];
            } while (at >= end && cluster != last);
        float probability = (cluster == last ? 1.0 : end) - begin;
        Sampler s = vertexSampler(path, depth, params.point_count, index * params.candidate_count + k, params.light_seed + cluster);
        LightSample light = sampleCluster(loadCluster(params.first_cluster + cluster), v.surface.position, nextLightDraws(s));
        vec3 candidate = unshadowed(v, light) / probability;
        float weight = luminance(candidate) * (kKnowsSeen && set == kSeenLights ? visibleOf(tile, cluster) : 1.0);
        if (weight > 0.0)
        {
            sum += weight;
            float kept = 1.0 - weight / sum; // with this probability the choice so far stays; one draw serves for all
            if (draw < kept)
                draw /= kept;
            else
            {
                draw = (draw - kept) / (1.0 - kept);
                chosen = light;
                carried = candidate;
                chosen_weight = weight;
            }
        }
        if (++k >= count)
            break;
    }
    if (sum > 0.0)
    {
        result.ray = shadowRay(v.surface, chosen, path);
        result.radiance = carried * (sum / (chosen_weight * float(count)));
    }
    return result;
}

/// Whether a ray passes the box around all that emits.
bool mayMeetEmitters(Ray ray)
{
    vec3 inverse = safeInverse(ray.direction);
    vec3 a = (params.emitters_low - ray.origin) * inverse, b = (params.emitters_high - ray.origin) * inverse;
    vec3 enter = min(a, b), leave = max(a, b);
    return max(max(enter.x, enter.y), max(enter.z, 0.0)) <= min(leave.x, min(leave.y, leave.z));
}

/// To where the BSDF leads, which may be an emitter.
void sendEmitterRay(PathVertex v, vec3 throughput, uint path, float choice, vec2 u)
{
    if (!hasFeature(kFeatureTriangleLights | kFeatureEnvironment))
        return;
    BsdfSample next = sampleBsdf(v.bsdf, v.wo, choice, u);
    vec3 wi = v.frame * next.wi;
    if (next.pdf == 0.0 || next.weight == vec3(0.0) || !sidesAgree(v.surface, wi, next.wi.z))
        return;
    Ray ray = leavingRay(v.surface, wi, kInfinity, path);
    if (!mayMeetEmitters(ray))
        return;
    uint slot = atomicAdd(emitter_queue.count, 1u);
    rays[slot] = ray;
    emitter_rays[slot] = EmitterRay(throughput * next.weight, next.pdf);
}

void main()
{
    uint path = tiledPixel(gl_GlobalInvocationID.x, params.width, params.point_count);
    if (path >= params.point_count)
        return;
    ShadingPoint point = loadPoint(path);
    if (point.slot == kNone)
        return;
    PathVertex v = vertexAt(point);
    if (!hasDensity(v.bsdf))
        return;
    uint index = params.first_sample * params.light_sample_count + params.light_sample;
    vec3 throughput = point.throughput / float(params.light_sample_count);
    Sampler bsdf_sampler = vertexSampler(path, point.depth + 1u, params.point_count, index, params.seed);
    if (hasFeature(kFeatureDispersion))
        disperse(v, point.throughput, dispersionDraw(bsdf_sampler));
    bsdf_sampler.dimension += kLightPairs;
    vec2 u = nextPair(bsdf_sampler), choice = nextPair(bsdf_sampler);

    uint tile = 0u;
    uvec2 lights = uvec2(0u); // a group of one cluster: all in the last set
    float draw_rest = 0.0;
    if (kKnowsSeen)
    {
        uint plane = quotient(path, params.pixel_count), height = quotient(params.pixel_count, params.width), bits = hash(hash(gl_GlobalInvocationID.x / kBlock, index), params.seed);
        tile = plane * tileColumns(params.width) * tileColumns(height) +
               tileNear(path - plane * params.pixel_count, params.width, height, vec2(bits & 0xffffu, bits >> 16) / 65536.0);
        lights = uvec2(tiles[tile].sure, tiles[tile].seen);
        draw_rest = toUnitFloat(hash(bits));
    }
    uint rest = (0xffffffffu >> (32u - params.cluster_count)) & ~(lights.x | lights.y);
    // Most of what no ray around has reached is hidden: few of the blocks send rays there.
    float rest_share = (lights.x | lights.y) == 0u ? 1.0 : kRestShare;
    ShadowRay to_sure = sampleSet(kSureLights, kKnowsSeen ? lights.x : 0u, v, path, point.depth + 1u, index, tile, choice.y);
    ShadowRay to_seen = sampleSet(kSeenLights, kKnowsSeen ? lights.y : 0u, v, path, point.depth + 1u, index, tile, choice.y);
    ShadowRay to_rest = sampleSet(kRestLights, draw_rest < rest_share ? rest : 0u, v, path, point.depth + 1u, index, tile, choice.y);
    to_rest.radiance /= rest_share;
    if (params.traces_bsdf_samples != 0u)
        sendEmitterRay(v, throughput, path, choice.x, u);
    vec3 light = vec3(0.0);
    for (uint set = kKnowsSeen ? kSureLights : kRestLights;;) // rays come last, when they need registers most
    {
        ShadowRay shadow = set == kSureLights ? to_sure : set == kSeenLights ? to_seen : to_rest;
        if (kCountsRays && shadow.radiance != vec3(0.0))
            atomicAdd(shadow_count.count, 1u);
        if (shadow.radiance != vec3(0.0))
            light += shadow.radiance * transmittance(shadow.ray.origin, shadow.ray.direction, shadow.ray.t_max);
        if (++set >= kLightSets)
            break;
    }
    if (light != vec3(0.0))
        radiance[path] += throughput * light;
}
