#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/cut/cut.h"
#include "shaders/lib/trace.glsl"
#include "shaders/lib/cut_node.glsl"
#include "shaders/lib/random.glsl"

// Samples the direction of every node of the cut: that of one of its photons, chosen with probability proportional to power, so
// that the expectation over nodes and frames is correct (Walter et al. 2005, representative lights). Also sets the point from
// which its disc is tested for visibility. The mean of photons around a column, or on both sides of a wall's foot, lies inside
// it: such a node is centred on the chosen photon. One thread per node.

layout(local_size_x = kCutGroupSize) in;
layout(push_constant, scalar) uniform Params { SampleDirectionParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer CutSize { QueueSize cut_size; };
layout(set = 1, binding = 1, scalar) readonly buffer Ids { uint ids[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Size { QueueSize size; }; // photons
layout(set = 1, binding = 3) uniform usamplerBuffer TreeNodes;                 // over them
layout(set = 1, binding = 4) uniform usamplerBuffer Photons;
layout(set = 1, binding = 5, scalar) readonly buffer Sums { PhotonSums sums[]; };
layout(set = 1, binding = 6, scalar) buffer Finals { CutNode finals[]; };           // by id
layout(set = 1, binding = 7, scalar) writeonly buffer Spheres { vec4 spheres[]; };  // by node
layout(set = 1, binding = 8, scalar) writeonly buffer Directions { uint directions[]; }; // by node
#include "shaders/lib/photon_node.glsl"

float weightOf(uint id)
{
    return isPhoton(id) ? luminance(loadPhoton(id + 1u - size.count).power) : sums[id].weight;
}

/// One of the node's photons, by power.
Photon chosenPhoton(uint id)
{
    float u = toUnitFloat(hash(params.seed, id));
    while (!isPhoton(id))
    {
        uint left = childId(loadTreeNode(id).left), right = childId(loadTreeNode(id).right);
        float share = weightOf(left) / max(weightOf(left) + weightOf(right), 1e-30);
        bool goes_left = u < share;
        u = clamp(goes_left ? u / share : (u - share) / (1.0 - share), 0.0, 0.9999999);
        id = goes_left ? left : right;
    }
    return loadPhoton(id + 1u - size.count);
}

/// How high above a photon the disc of a node around it is seen from: half way to what is above it, where that is near.
float heightAbove(vec3 position, vec3 normal, float support)
{
    float most = kProbeHeight * support;
    return 0.5 * closestHit(offsetOrigin(position, normal), normal, kRayStart, 2.0 * most, params.seed).t;
}

bool isFree(vec3 from, vec3 to)
{
    float distance = length(to - from);
    bool met_translucent;
    return distance == 0.0 || !meetsOpaque(from, (to - from) / distance, distance, met_translucent);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= cut_size.count)
        return;
    uint id = ids[i];
    Photon photon = chosenPhoton(id);
    CutNode node = finals[id];
    if (params.is_probed != 0u)
    {
        vec3 normal = cutNormal(node);
        float height = heightAbove(photon.position, normal, node.support);
        vec3 eye = photon.position + height * normal;
        // At the same height: the mean of photons on a bent surface lies below it.
        vec3 center = node.center + dot(photon.position - node.center, normal) * normal;
        if (isFree(eye, center + height * normal))
            height = max(height + dot(photon.position - node.center, normal), 0.0);
        else
            node.center = photon.position;
        finals[id].center = node.center;
        finals[id].normal_and_eye = packCutNormal(normal, max(height, 1e-6 * node.support), node.support);
    }
    spheres[i] = vec4(node.center, node.support);
    directions[i] = photon.direction;
}
