#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/samples/quadtree.glsl"

// Sums of a level of the quadtree from the level below. One thread per node. One group goes on up to
// params.last_level: with a dispatch for each, levels of few nodes take as long as those of many.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { SeedParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Points { SamplePoint points[]; };
layout(set = 1, binding = 1, scalar) coherent buffer Nodes { QuadNode nodes[]; };

QuadNode child(uint level, uint i)
{
    if (level > 1u)
        return nodes[levelOffset(level - 1u, params.levels) + i];
    if (i >= points.length() || points[i].pixel == kNone)
        return QuadNode(vec3(0.0), 0u, vec3(0.0), 0u);
    SamplePoint point = points[i];
    return QuadNode(point.position, 1u, unpackNormal(point.normal), 0u);
}

void sumChildren(uint level, uint i)
{
    if (i >= levelCount(level, params.levels))
        return;
    QuadNode sum = child(level, 4u * i);
    for (uint c = 1u; c < 4u; ++c)
    {
        QuadNode other = child(level, 4u * i + c);
        sum = QuadNode(sum.position + other.position, sum.count + other.count, sum.normal + other.normal, 0u);
    }
    nodes[levelOffset(level, params.levels) + i] = sum;
}

void main()
{
    for (uint level = params.level;; ++level)
    {
        sumChildren(level, gl_GlobalInvocationID.x);
        if (level == params.last_level)
            break;
        memoryBarrierBuffer();
        barrier();
    }
}
