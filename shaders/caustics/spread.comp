#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/caustics/caustics.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/view_scale.glsl"

// How far each caustic photon spreads its light: over the disc that its k nearest photons lie in, so that about as many discs
// lie over any point, however dense the photons are there. One thread per photon.

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
#include "shaders/lib/density.glsl"

/// Squared radius of as many photons as are wanted, if they lie as evenly over a plane as those of the smallest node above the photon
/// that holds as many: in a focus, where a search from `most2` on would visit most of the map, next to the right one.
float likelyRadius2(uint photon, float most2)
{
    if (size.count <= params.photon_count)
        return most2;
    uint node = leaf_parents[photon] & ~kTreeLeafBit;
    for (;;)
    {
        if (node == 0u || loadTreeNode(node).count >= params.photon_count)
            break;
        node = node_parents[node] & ~kTreeLeafBit;
    }
    TreeNode n = loadTreeNode(node);
    vec3 extent = max(n.left_max, n.right_max) - min(n.left_min, n.right_min);
    float area = 0.5 * dot(extent, extent); // of a square with that diagonal
    return clamp(area * kInvPi * float(params.photon_count) / float(n.count), 1e-6 * most2, most2);
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
    float support2 = nearestRadius2(photon.position, unpackNormal(photon.normal), size.count, params.photon_count, most2, likelyRadius2(i, most2));
    support2 = max(support2, min(square(leastRadius(photon.position)), most2));
    spheres[order[i]] = vec4(photon.position, sqrt(support2));
    supports[i] = support2;
}
