#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/direct/direct.h"
#include "shaders/lib/bvh.glsl"
#include "shaders/lib/tile.glsl"
#include "shaders/lib/unshadowed.glsl"

// Samples direct light at every shading point: a shadow ray to a light of the group, or one to clusters of lamps that are seen
// around and one to the rest of them, and, once for all groups, a BSDF-sampled ray that may end on an emitter (emitted.comp
// weights it). The light is chosen among candidates picked by power and by what is seen of their clusters, with probability
// proportional to its contribution (Talbot et al. 2005, "Importance Resampling for Global Illumination"). One thread per point;
// queues hold one ray a point at most.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { DirectParams params; };

layout(set = 1, binding = 0) uniform usamplerBuffer Points;
layout(set = 1, binding = 1, scalar) buffer ShadowQueue { QueueSize shadow_queue; };
layout(set = 1, binding = 2, scalar) writeonly buffer ShadowRays { ShadowRay shadow_rays[]; };
layout(set = 1, binding = 3, scalar) buffer EmitterQueue { QueueSize emitter_queue; };
layout(set = 1, binding = 4, scalar) writeonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer EmitterRays { EmitterRay emitter_rays[]; };
layout(set = 1, binding = 6) uniform usamplerBuffer Picks;
layout(set = 1, binding = 7) uniform usamplerBuffer Clusters;
layout(set = 1, binding = 8) uniform usamplerBuffer Tiles;
layout(set = 1, binding = 9, scalar) buffer RestQueue { QueueSize rest_queue; };
layout(set = 1, binding = 10, scalar) writeonly buffer RestRays { ShadowRay rest_rays[]; };

#include "shaders/lib/light_cluster.glsl"
#include "shaders/lib/point.glsl"

layout(constant_id = 3) const bool kKnowsSeen = false; // the group has several clusters, of which tiles know what they see

const uint kSeen = 0u, kRest = 1u; // what a shadow ray is for

// TileLights as texels of four clusters: cumulative probabilities of both sets, then what is visible.
const uint kSetTexels = kMostClusters / 4u, kTileTexels = 3u * kSetTexels;

float tileEntry(uint tile, uint set, uint cluster)
{
    return uintBitsToFloat(texelFetch(Tiles, int(kTileTexels * tile + kSetTexels * set + cluster / 4u))[cluster % 4u]);
}

/// Whether the tile has any cluster of this set: otherwise probabilities end at 0, not at 1.
bool hasClusters(uint tile, uint set) { return tileEntry(tile, set, params.cluster_count - 1u) > 0.0; }
float visibleOf(uint tile, uint cluster) { return tileEntry(tile, 2u, cluster); }

/// The cluster that holds u in [0, 1) @param probability of it
uint pickCluster(uint tile, uint set, float u, out float probability)
{
    uint cluster = 0u;
    float begin = 0.0, end = 1.0;
    uint last = params.cluster_count - 1u; // takes what is left
    for (uint first = 0u;;) // tests at its end: see lib/bvh.glsl why
    {
        vec4 ends = uintBitsToFloat(texelFetch(Tiles, int(kTileTexels * tile + kSetTexels * set + first / 4u)));
        bvec4 counts = lessThan(first + uvec4(0u, 1u, 2u, 3u), uvec4(last));
        bvec4 below = lessThanEqual(ends, vec4(u));
        vec4 begins = mix(vec4(0.0), ends, bvec4(uvec4(counts) & uvec4(below)));
        ends = mix(vec4(1.0), ends, bvec4(uvec4(counts) & uvec4(not(below))));
        uvec4 passed = uvec4(counts) & uvec4(below);
        cluster += passed.x + passed.y + passed.z + passed.w;
        begin = max(begin, max(max(begins.x, begins.y), max(begins.z, begins.w)));
        end = min(end, min(min(ends.x, ends.y), min(ends.z, ends.w)));
        first += 4u;
        if (first >= last)
            break;
    }
    probability = end - begin;
    return cluster;
}

/// The shadow ray of one set of clusters goes to one of several candidates.
void sampleSet(uint set, uint candidate_count, PathVertex v, vec3 throughput, uint path, uint depth, uint index, uint tile, float draw)
{
    LightSample chosen = kNoLight;
    vec3 carried = vec3(0.0);
    float sum = 0.0, chosen_weight = 0.0, turn = toUnitFloat(hash(hash(path, index), params.light_seed + set));
    for (uint k = 0u;;)
    {
        uint cluster = 0u;
        float probability = 1.0, visible = 1.0;
        if (kKnowsSeen)
        {
            cluster = pickCluster(tile, set, (float(k) + turn) / float(candidate_count), probability);
            visible = visibleOf(tile, cluster);
        }
        Sampler s = vertexSampler(path, depth, params.point_count, index * params.candidate_count + k, params.light_seed + set);
        LightSample light = sampleCluster(loadCluster(params.first_cluster + cluster), v.surface.position, nextLightDraws(s));
        vec3 candidate = throughput * unshadowed(v, light) / probability;
        float weight = luminance(candidate) * visible;
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
        if (++k >= candidate_count)
            break;
    }
    if (sum > 0.0)
    {
        ShadowRay ray = ShadowRay(shadowRay(v.surface, chosen, path), carried * (sum / (chosen_weight * float(candidate_count))), 0.0);
        if (set == kSeen)
            shadow_rays[atomicAdd(shadow_queue.count, 1u)] = ray;
        else
            rest_rays[atomicAdd(rest_queue.count, 1u)] = ray;
    }
}

/// Whether a ray passes the box around all that emits.
bool mayMeetEmitters(Ray ray)
{
    vec3 inverse = safeInverse(ray.direction);
    vec3 a = (params.emitters_low - ray.origin) * inverse, b = (params.emitters_high - ray.origin) * inverse;
    vec3 enter = min(a, b), leave = max(a, b);
    return max(max(enter.x, enter.y), max(enter.z, 0.0)) <= min(leave.x, min(leave.y, leave.z));
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
    Surface s = v.surface;
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
    if (kKnowsSeen)
    {
        uint plane = quotient(path, params.pixel_count), height = quotient(params.pixel_count, params.width), bits = hash(hash(path, index), params.seed);
        tile = plane * tileColumns(params.width) * tileColumns(height) +
               tileNear(path - plane * params.pixel_count, params.width, height, vec2(bits & 0xffffu, bits >> 16) / 65536.0);
    }
    for (uint set = kSeen;;)
    {
        if (!kKnowsSeen || hasClusters(tile, set))
            sampleSet(set, set == kSeen ? params.candidate_count : (params.candidate_count + 1u) / 2u, v, throughput, path, point.depth + 1u, index, tile, choice.y);
        if (!kKnowsSeen || set++ == kRest)
            break;
    }

    if (!hasFeature(kFeatureTriangleLights | kFeatureEnvironment) || params.traces_bsdf_samples == 0u)
        return;
    BsdfSample next = sampleBsdf(v.bsdf, v.wo, choice.x, u);
    vec3 wi = v.frame * next.wi;
    if (next.pdf == 0.0 || next.weight == vec3(0.0) || !sidesAgree(s, wi, next.wi.z))
        return;
    Ray ray = leavingRay(s, wi, kInfinity, path);
    if (!mayMeetEmitters(ray))
        return;
    uint slot = atomicAdd(emitter_queue.count, 1u);
    rays[slot] = ray;
    emitter_rays[slot] = EmitterRay(throughput * next.weight, next.pdf);
}
