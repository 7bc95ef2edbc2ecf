#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/climb.glsl"
#include "shaders/lib/math.glsl"
#include "shaders/pose/pose.h"

// Puts moving triangles where their vertices are, keeps where they were, and fits the boxes above them bottom-up: the thread
// that arrives last at a node continues with it, so that no thread waits. One thread per moving leaf.

layout(local_size_x = kPoseGroupSize) in;
layout(push_constant, scalar) uniform Params { PoseParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Positions { vec3 positions[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Triangles { Triangle triangles[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Leaves { PosedLeaf leaves[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Parents { uint parents[]; }; // of moving nodes: where they hang
layout(set = 1, binding = 4, scalar) buffer Slots { BvhTriangle slots[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer LastCorners { TriangleCorners last_corners[]; };
layout(set = 1, binding = 6, scalar) coherent buffer Nodes { float planes[]; };
layout(set = 1, binding = 7, scalar) coherent buffer Arrivals { uint arrivals[]; }; // 0 before

const uint kNodeWords = 28u; // of a BvhNode: min x, max x, min y, max y, min z, max z of each child; children

struct Box
{
    vec3 low, high;
};

const Box kNowhere = Box(vec3(kInfinity), vec3(-kInfinity));

void include(inout Box box, vec3 p)
{
    box.low = min(box.low, p);
    box.high = max(box.high, p);
}

Box placeTriangles(uint reference)
{
    Box box = kNowhere;
    uint first = reference & kLeafFirstMask, end = first + (reference >> kLeafCountShift & kLeafCountMask) + 1u;
    for (uint slot = first; slot < end; ++slot)
    {
        uvec3 v = triangles[slots[slot].triangle].vertices - params.first_vertex;
        last_corners[slot - params.first_slot] = TriangleCorners(slots[slot].v0, slots[slot].v1, slots[slot].v2);
        slots[slot].v0 = positions[v.x];
        slots[slot].v1 = positions[v.y];
        slots[slot].v2 = positions[v.z];
        if (positions[v.x] == positions[v.y] && positions[v.y] == positions[v.z]) // hidden, or a scale of 0
            continue;
        include(box, positions[v.x]);
        include(box, positions[v.y]);
        include(box, positions[v.z]);
    }
    return box;
}

void setChild(uint node, uint child, Box box)
{
    for (uint axis = 0u; axis < 3u; ++axis)
    {
        planes[kNodeWords * node + 8u * axis + child] = box.low[axis];
        planes[kNodeWords * node + 8u * axis + 4u + child] = box.high[axis];
    }
}

uint childrenOf(uint node)
{
    uint count = 0u;
    for (uint child = 0u; child < kBvhWidth; ++child)
        count += floatBitsToUint(planes[kNodeWords * node + 24u + child]) != kNone ? 1u : 0u;
    return count;
}

/// Of all children: the planes of those that are not there are upside down.
Box boxOf(uint node)
{
    Box box = kNowhere;
    for (uint axis = 0u; axis < 3u; ++axis)
        for (uint child = 0u; child < kBvhWidth; ++child)
        {
            box.low[axis] = min(box.low[axis], planes[kNodeWords * node + 8u * axis + child]);
            box.high[axis] = max(box.high[axis], planes[kNodeWords * node + 8u * axis + 4u + child]);
        }
    return box;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.leaf_count)
        return;
    uint link = leaves[i].link;
    Box box = placeTriangles(leaves[i].reference);
    while (true)
    {
        uint node = link / kBvhWidth;
        setChild(node, link % kBvhWidth, box);
        if (node < params.first_node || node == 0u) // the root
            return;
        fence();
        if (atomicAdd(arrivals[node - params.first_node], 1u) + 1u < childrenOf(node))
            return;
        fence();
        box = boxOf(node);
        link = parents[node - params.first_node];
    }
}
