#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/false_color.glsl"
#include "shaders/views/views.h"

// Every shading point in the colour of the photon-tree node that it falls into, on the level of about kViewTreeNodes nodes.
// One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ViewParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 2, scalar) readonly buffer Points { ShadingPoint points[]; };
layout(set = 1, binding = 3, scalar) buffer Radiance { vec3 radiance[]; };
#include "shaders/lib/tree.glsl"

/// Index of the first photon of x's node: down from the root to the nearer child while there are more than `most` in it.
uint firstOfNode(vec3 x, uint most)
{
    TreeNode node = loadTreeNode(0u);
    while (node.count > most)
    {
        float left2 = boxDistance2(x, x, node.left_min, node.left_max), right2 = boxDistance2(x, x, node.right_min, node.right_max);
        uint child = left2 <= right2 ? node.left : node.right;
        if ((child & kTreeLeafBit) != 0u)
            return child & ~kTreeLeafBit;
        node = loadTreeNode(child);
    }
    return node.first;
}

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.width * params.height)
        return;
    bool shown = points[pixel].slot != kNone && size.count > 1u;
    vec3 color = groundColor(radiance[pixel], params.exposure, params.curve);
    if (shown)
        color = indexColor(firstOfNode(points[pixel].position, max(size.count / kViewTreeNodes, 1u)));
    radiance[pixel] = color;
}
