#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/lib/scene.glsl"
#include "shaders/lib/variation.glsl"
#include "shaders/samples/quadtree.glsl"

// Every point's variation to all the nodes it belongs to, summed by node (Algorithm 1). Fixed-point sums: equal bits
// whatever the order. One thread per point; nodes of the lower levels lie within one group and are summed there.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { SeedParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Points { SamplePoint points[]; };
layout(set = 1, binding = 1, scalar) buffer Nodes { QuadNode nodes[]; };

shared uint level_sums[kSamplesGroupSize];

float alpha() { return params.alpha / view_scale.distance; } // of Eq. 2, per metre

uint variationTo(SamplePoint point, uint node)
{
    if (point.pixel == kNone)
        return 0u;
    QuadNode n = nodes[node];
    float resultant = length(n.normal);
    if (resultant < 1e-6) // opposite normals: no node to vary from
        return 0u;
    float eps = geometricVariation(alpha(), point.position, unpackNormal(point.normal), n.position / float(n.count), n.normal / resultant);
    return uint(min(eps, kMostVariation) * params.variation_scale);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    uint local_ = gl_LocalInvocationID.x;
    SamplePoint point = SamplePoint(vec3(0.0), 0u, kNone);
    if (i < points.length())
        point = points[i];
    for (uint level = 1u; level <= params.levels; ++level)
    {
        uint shift = 2u * min(level, kGroupLevels);
        uint node = levelOffset(level, params.levels) + (i >> (2u * level));
        level_sums[local_] = 0u;
        barrier();
        uint eps = variationTo(point, node);
        if (eps > 0u)
            atomicAdd(level_sums[local_ >> shift], eps);
        barrier();
        bool first_of_node = (local_ & ((1u << shift) - 1u)) == 0u;
        if (first_of_node && level_sums[local_ >> shift] > 0u)
            atomicAdd(nodes[node].variation, level_sums[local_ >> shift]);
        barrier();
    }
}
