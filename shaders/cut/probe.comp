#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/trace.glsl"
#include "shaders/lib/cut_node.glsl"
#include "shaders/lib/random.glsl"

// Divides a node's irradiance by the fraction of its disc that lies on the surface and is visible, so that at edges, corners,
// walls and thin columns no power is spread beside the surface or behind the wall. Probe rays find it: from a point above the node's
// centre to points on its disc, chosen by the node's weight there. They end where the disc lies on a visible surface. Others go to
// the disc's rim and detect whether anything stands on it. kProbeThreads threads per node.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ProbeParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) buffer Nodes { CutNode nodes[]; };

const uint kGroupNodes = kRaysGroupSize / kProbeThreads;
const float kMostOfARay = 4.0; // limits the weight of a surface at a grazing angle

shared float parts[kGroupNodes][kMostProbes]; // of each ray: what it covers; to the rim: 1 where it arrives

/// From the node's eye to a place of its disc. @param frame its third axis is the node's normal
Ray rayToDisc(CutNode node, mat3 frame, float height, uint path, Sampler sampler_)
{
    vec2 u = nextPair(sampler_);
    float phi = 2.0 * kPi * u.y, r = sqrt(1.0 - sqrt(1.0 - u.x));
    vec3 to_place = vec3(r * cos(phi) * node.support, r * sin(phi) * node.support, -height);
    float below = 0.25 * sqrt(1.0 - r * r) * node.support; // how far off its plane the node has any weight
    float distance = length(to_place);
    return Ray(node.center + height * frame[2], distance * (1.0 + below / max(height, 1e-20)), frame * to_place / distance, path);
}

/// Just above the rim: a bump of the floor must not count as a wall. @param turn along it, of 1
Ray rayToRim(CutNode node, mat3 frame, float height, uint path, float turn)
{
    float phi = 2.0 * kPi * turn;
    vec3 to_rim = vec3(cos(phi) * node.support, sin(phi) * node.support, -0.95 * height);
    float distance = length(to_rim);
    return Ray(node.center + height * frame[2], distance, frame * to_rim / distance, path);
}

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

/// @param node its place in the group, @param i in the cut
void traceProbes(uint node, uint i, uint thread, ProbeParams probes)
{
    CutNode n = nodes[i];
    vec3 normal = cutNormal(n);
    mat3 frame = frameAround(normal);
    float height = eyeHeight(n), turn = toUnitFloat(hash(params.seed, ~i));
    uint all = probes.ray_count + probes.rim_count;
    for (uint k = thread;;) // tests at its end: see lib/bvh.glsl why
    {
        bool to_disc = k < probes.ray_count;
        float along = (float(k - probes.ray_count) + turn) / float(max(probes.rim_count, 1u));
        Ray ray = rayToRim(n, frame, height, i * all + k, along);
        if (to_disc)
            ray = rayToDisc(n, frame, height, i * all + k, Sampler(hash(params.seed, i), k, 0u));
        Hit hit = closestHit(ray.origin, ray.direction, kRayStart, ray.t_max, hash(params.seed, ray.path));
        parts[node][k] = to_disc ? covered(n, normal, ray, hit) : float(hit.slot == kNone);
        k += kProbeThreads;
        if (k >= all)
            break;
    }
}

void main()
{
    uint node = gl_LocalInvocationID.x / kProbeThreads, thread = gl_LocalInvocationID.x % kProbeThreads;
    uint i = gl_WorkGroupID.x * kGroupNodes + node;
    ProbeParams probes = probesFor(size.count, params);
    bool is_probed = i < size.count && probes.ray_count > 0u;
    if (is_probed && thread < probes.ray_count + probes.rim_count)
        traceProbes(node, i, thread, probes);
    barrier();
    if (!is_probed || thread > 0u)
        return;
    float sum = 0.0, squares = 0.0, arrived = 0.0;
    for (uint k = 0u; k < probes.ray_count; ++k)
    {
        sum += parts[node][k];
        squares += square(parts[node][k]);
    }
    for (uint k = 0u; k < probes.rim_count; ++k)
        arrived += parts[node][probes.ray_count + k];
    if (probes.rim_count > 0u && sum > float(probes.ray_count) - 0.5 && arrived == float(probes.rim_count))
        nodes[i].normal_and_eye |= kCutIsClear; // all of its disc is on the surface and visible: lookups need no visibility ray
    else
        nodes[i].irradiance *= inverseMean(float(probes.ray_count), sum, squares);
}
