// A node of the photon tree as a node of the cut. What lib/photon_node.glsl wants declared. Functions only.
#ifndef LIB_SPREAD_GLSL
#define LIB_SPREAD_GLSL
#include "shaders/lib/cut_node.glsl"
#include "shaders/lib/photon_node.glsl"
#include "shaders/lib/view_scale.glsl"

/// How far, metres, a density estimate at x may reach: a cap against the blur of places where photons are few.
float reachAt(vec3 x, CutParams params) { return params.radius * viewDistance(x); }

/// Radius, metres, of as many photons as density estimation takes, if they lie as evenly as those of the node, or of the nearest
/// node above it that has more than kCutFewest: no search. The kernel declares `buffer LeafParents { uint leaf_parents[]; }`
/// and `buffer NodeParents { uint node_parents[]; }`.
float evenRadius(uint id, PhotonNode node, CutParams params)
{
    while (node.count <= kCutFewest)
    {
        if (id == 0u)
            return reachAt(node.center, params); // so few photons do not determine a density
        id = (isPhoton(id) ? leaf_parents[id + 1u - size.count] : node_parents[id]) & ~kTreeLeafBit;
        node = photonNode(id);
    }
    return min(reachAt(node.center, params), sqrt(kInvPi * node.area * float(params.photon_count) / float(node.count)));
}

/// The power of the node's photons, spread over `support` metres around their centre.
CutNode spreadNode(uint id, PhotonNode node, float support)
{
    vec3 power;
    if (isPhoton(id))
        power = loadPhoton(id + 1u - size.count).power;
    else
        power = sums[id].power;
    support = max(support, 1e-6);
    return CutNode(node.center, support, power / cutArea(support), packCutNormal(node.normal, 0.0, support));
}

#endif
