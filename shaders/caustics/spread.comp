#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/caustics/caustics.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/view_scale.glsl"

// How far each caustic photon spreads its light: over a disc of about as many photons as are wanted, so that about as many discs lie over
// any point, however dense the photons are there. All light arrives, whatever the discs are (Silverman 1986, section 5.3, the adaptive
// kernel method, asks for no exact density), so the tree tells the density, without a search. One thread per photon.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { SpreadPhotonsParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 2) uniform usamplerBuffer Photons;
layout(set = 1, binding = 3, scalar) readonly buffer Order { uint order[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer Spheres { vec4 spheres[]; }; // as the tree was built from
layout(set = 1, binding = 5, scalar) writeonly buffer Supports { float supports[]; }; // squared radii, metres
layout(set = 1, binding = 6, scalar) readonly buffer LeafParents { uint leaf_parents[]; };
layout(set = 1, binding = 7, scalar) readonly buffer NodeParents { uint node_parents[]; };
#include "shaders/lib/photon.glsl"
#include "shaders/lib/tree.glsl"

/// Squared radius of the disc of as many photons as are wanted, if they lie as evenly as those of a node. Its photons lie in a plane; of
/// that, the node's share is that of a square in its box.
float discOf(TreeNode node)
{
    vec3 extent = max(node.left_max, node.right_max) - min(node.left_min, node.right_min);
    return 0.5 * dot(extent, extent) * kInvPi * float(params.photon_count) / float(node.count);
}

/// By the densest of the nodes above a photon that hold a quarter of the photons wanted or more, up to the first that holds all: the cells
/// of a tree end where they happen to, and one that holds all may reach from a focus far into the dark.
float discAround(uint photon, float most2)
{
    if (size.count < 2u)
        return most2;
    float disc = most2;
    uint node = leaf_parents[photon] & ~kTreeLeafBit;
    for (;;)
    {
        TreeNode n = loadTreeNode(node);
        bool tells = 4u * n.count >= params.photon_count;
        disc = tells ? min(disc, discOf(n)) : disc;
        if (node == 0u || n.count >= params.photon_count)
            break;
        node = node_parents[node] & ~kTreeLeafBit;
    }
    return disc;
}

/// Discs much narrower than a pixel would show between pixels, and flicker: they reach to the next one at least.
float leastRadius(vec3 p) { return params.pixel_side + params.pixel_angle * length(p - params.eye); }

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count)
        return;
    Photon photon = loadPhoton(i);
    float most2 = square(params.radius * viewDistance(photon.position));
    float support2 = max(discAround(i, most2), min(square(leastRadius(photon.position)), most2));
    spheres[order[i]] = vec4(photon.position, sqrt(support2));
    supports[i] = support2;
}
