// A node of the photon tree as a node of the cut. What lib/photon_node.glsl wants declared. Functions only.
#ifndef LIB_SPREAD_GLSL
#define LIB_SPREAD_GLSL
#include "shaders/lib/cut_node.glsl"
#include "shaders/lib/photon_node.glsl"

/// The power of the node's photons, spread over `support` metres around their centre.
CutNode spreadNode(uint id, PhotonNode node, float support)
{
    vec3 power;
    if (isPhoton(id))
        power = loadPhoton(id + 1u - size.count).power;
    else
        power = sums[id].power;
    support = max(support, 1e-6);
    return CutNode(node.center, support, power / cutArea(support), packNormal(node.normal));
}

#endif
