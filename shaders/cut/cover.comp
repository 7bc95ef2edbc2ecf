#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/cut_node.glsl"
#include "shaders/lib/surface.glsl"

// Gives a node at an edge, in a corner or on a thin column the light that it would spread beside the surface: its
// irradiance is divided by the part of its disc that is there. One thread per node.

layout(local_size_x = kCutGroupSize) in;
layout(push_constant, scalar) uniform Params { ProbeParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer Rays;
layout(set = 1, binding = 2) uniform usamplerBuffer Hits;
layout(set = 1, binding = 3, scalar) buffer Nodes { CutNode nodes[]; };
#include "shaders/lib/hit.glsl"
#include "shaders/lib/ray.glsl"

/// The node's weight where a ray came down, times the area that it stands for, against what a plane would have there: x where
/// the ray met a surface's front, y where it met its back.
vec2 covered(CutNode node, vec3 normal, Ray ray, Hit hit)
{
    if (hit.slot == kNone)
        return vec2(0.0);
    Surface s = surfaceAt(hit.slot, hit.barycentrics, ray.direction);
    vec3 on_plane = ray.origin - normal * dot(ray.origin - node.center, normal);
    float weight = cutWeight(node, s.position, s.geometric_normal) /
                   (max(cutWeight(node, on_plane, normal), 1e-3) * max(dot(s.geometric_normal, normal), 0.2));
    bool front = s.front || (loadMaterial(s.material).flags & kMaterialDoubleSided) != 0u;
    return front ? vec2(weight, 0.0) : vec2(0.0, weight);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    uint ray_count = probeCount(size.count, params.ray_count);
    if (i >= size.count || ray_count == 0u)
        return;
    CutNode node = nodes[i];
    vec3 normal = unpackNormal(node.normal);
    vec2 sums = vec2(0.0);
    for (uint k = i * ray_count; k < (i + 1u) * ray_count; ++k)
        sums += covered(node, normal, loadRay(k), loadHit(k));
    // Backs are the inside of something solid, unless they are most of what there is: photons lie on backs, too.
    float sum = max(sums.x, sums.y);
    // (n + 1) / (sum + 1): of n independent rays its mean is 1 / the part that is there, not more.
    nodes[i].irradiance *= min(float(ray_count + 1u) / (sum + 1.0), kMostUncovered);
}
