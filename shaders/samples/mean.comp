#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/samples/quadtree.glsl"

// Sums of one level of the quadtree from the level below. One thread per node.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { SeedParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Points { SamplePoint points[]; };
layout(set = 1, binding = 1, scalar) buffer Nodes { QuadNode nodes[]; };

QuadNode child(uint i)
{
    if (params.level > 1u)
        return nodes[levelOffset(params.level - 1u, params.levels) + i];
    if (i >= points.length() || points[i].pixel == kNone)
        return QuadNode(vec3(0.0), 0u, vec3(0.0), 0u);
    SamplePoint point = points[i];
    return QuadNode(point.position, 1u, unpackNormal(point.normal), 0u);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= levelCount(params.level, params.levels))
        return;
    QuadNode sum = child(4u * i);
    for (uint c = 1u; c < 4u; ++c)
    {
        QuadNode other = child(4u * i + c);
        sum = QuadNode(sum.position + other.position, sum.count + other.count, sum.normal + other.normal, 0u);
    }
    nodes[levelOffset(params.level, params.levels) + i] = sum;
}
