#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/cut/cut.h"
#include "shaders/lib/random.glsl"

// Whence light comes at every node of the cut: the direction of one of its photons, chosen by power, so that on average over
// nodes and frames every photon speaks for what it carries (Walter et al. 2005, representative lights). One thread per node.

layout(local_size_x = kCutGroupSize) in;
layout(push_constant, scalar) uniform Params { RepresentParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer CutSize { QueueSize cut_size; };
layout(set = 1, binding = 1, scalar) readonly buffer Ids { uint ids[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Order { uint order[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Size { QueueSize size; }; // photons
layout(set = 1, binding = 4) uniform usamplerBuffer TreeNodes;                 // over them
layout(set = 1, binding = 5) uniform usamplerBuffer Photons;
layout(set = 1, binding = 6, scalar) readonly buffer Sums { PhotonSums sums[]; };
layout(set = 1, binding = 7, scalar) writeonly buffer Directions { uint directions[]; };
#include "shaders/lib/photon_node.glsl"

float weightOf(uint id)
{
    return isPhoton(id) ? luminance(loadPhoton(id + 1u - size.count).power) : sums[id].weight;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= cut_size.count)
        return;
    uint id = ids[order[i]];
    float u = toUnitFloat(hash(params.seed, id));
    while (!isPhoton(id))
    {
        uint left = childId(loadTreeNode(id).left), right = childId(loadTreeNode(id).right);
        float share = weightOf(left) / max(weightOf(left) + weightOf(right), 1e-30);
        bool goes_left = u < share;
        u = clamp(goes_left ? u / share : (u - share) / (1.0 - share), 0.0, 0.9999999);
        id = goes_left ? left : right;
    }
    directions[i] = loadPhoton(id + 1u - size.count).direction;
}
