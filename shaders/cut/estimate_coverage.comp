#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/cut_node.glsl"
#include "shaders/lib/surface.glsl"

// Divides a node's irradiance by the fraction of its disc that lies on the surface and is visible, so that at edges, corners,
// walls and thin columns no power is spread beside the surface or behind the wall. One thread per node.

layout(local_size_x = kCutGroupSize) in;
layout(push_constant, scalar) uniform Params { ProbeParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer Rays;
layout(set = 1, binding = 2) uniform usamplerBuffer Hits;
layout(set = 1, binding = 3, scalar) buffer Nodes { CutNode nodes[]; };
#include "shaders/lib/hit.glsl"
#include "shaders/lib/ray.glsl"

const float kMostOfARay = 4.0; // limits the weight of a surface at a grazing angle

/// The node's weight at the end of a probe ray times the area that the ray represents, relative to the node's plane.
float covered(CutNode node, vec3 normal, Ray ray, Hit hit)
{
    if (hit.slot == kNone)
        return 0.0;
    Surface s = surfaceAt(hit.slot, hit.barycentrics, ray.direction);
    float down = -dot(ray.direction, normal), to_plane = dot(ray.origin - node.center, normal) / down;
    float weight = cutWeight(node, s.position, s.geometric_normal);
    float on_plane = cutWeight(node, ray.origin + to_plane * ray.direction, normal);
    float area = square(hit.t / to_plane) * down / max(-dot(s.geometric_normal, ray.direction), 1e-3);
    return min(weight / max(on_plane, 1e-3) * area, kMostOfARay);
}

/// 1 / the mean of n independent numbers, without bias where they are 0 or 1: the mean of (n + 1) / (sum + 1) is that. As far as
/// their variance is more than that of zeros and ones, by its first order.
float inverseMean(float n, float sum, float squares)
{
    float mean = max(sum / n, 0.5 / n), variance = squares / n - square(sum / n);
    float excess = max(0.0, variance - mean * (1.0 - mean));
    return (n + 1.0) / ((sum + 1.0) * (1.0 + excess / (n * square(mean))));
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    ProbeParams probes = probesFor(size.count, params);
    uint first = i * (probes.ray_count + probes.rim_count), rim = first + probes.ray_count;
    if (i >= size.count || probes.ray_count == 0u)
        return;
    CutNode node = nodes[i];
    vec3 normal = cutNormal(node);
    float sum = 0.0, squares = 0.0;
    for (uint k = first; k < rim; ++k)
    {
        float part = covered(node, normal, loadRay(k), loadHit(k));
        sum += part;
        squares += part * part;
    }
    bool is_clear = probes.rim_count > 0u && sum > float(probes.ray_count) - 0.5;
    for (uint k = rim; is_clear && k < rim + probes.rim_count; ++k)
        is_clear = loadHit(k).slot == kNone;
    if (is_clear) // all of its disc is on the surface and visible: lookups need no visibility ray
        nodes[i].normal_and_eye |= kCutIsClear;
    else
        nodes[i].irradiance *= inverseMean(float(probes.ray_count), sum, squares);
}
