// What a node of the photon tree says of the light around it. The kernel declares `buffer Size`,
// `buffer Sums { PhotonSums sums[]; }` and the usamplerBuffers TreeNodes and Photons before it includes this. Functions only.
#ifndef LIB_PHOTON_NODE_GLSL
#define LIB_PHOTON_NODE_GLSL
#include "shaders/cut/cut.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/photon.glsl"
#include "shaders/lib/tree.glsl"

bool isPhoton(uint id) { return id + 1u >= size.count; }
uint childId(uint child) { return (child & ~kTreeLeafBit) + ((child & kTreeLeafBit) != 0u ? size.count - 1u : 0u); }

PhotonSums photonSums(uint i)
{
    Photon photon = loadPhoton(i);
    float weight = luminance(photon.power);
    return PhotonSums(photon.power, weight, weight * unpackNormal(photon.normal), weight * photon.position);
}

/// Photons of a node that is not divided further.
uint fewestPhotons(CutParams params) { return max(params.fewest, size.count / params.most_nodes); }

struct PhotonNode
{
    vec3 center;      // metres
    vec3 normal;      // unit
    float longest;    // metres: longest side of its box
    float area;       // square metres: that its photons lie on; 0 for a single one
    float irradiance; // luminance of E~
    bool flat_;       // its photons lie near one plane and face one way: E~ means something
    uint count;       // photons
};

PhotonNode photonNode(uint id)
{
    if (isPhoton(id))
        return PhotonNode(loadPhoton(id + 1u - size.count).position, unpackNormal(loadPhoton(id + 1u - size.count).normal), 0.0, 0.0, 0.0, true, 1u);
    PhotonSums s = sums[id];
    vec3 extent = max(loadTreeNode(id).left_max, loadTreeNode(id).right_max) - min(loadTreeNode(id).left_min, loadTreeNode(id).right_min);
    float longest = maxComponent(extent);
    float resultant = length(s.normal); // of the cone of normals: s.weight where all are equal
    vec3 normal = resultant > 0.0 ? s.normal / resultant : vec3(0.0, 0.0, 1.0);
    vec3 n = abs(normal);
    // The box's shadow along the normal: exact for a flat patch along two axes, and never the huge (longest side)^2 of a
    // long, narrow one.
    // The box of n photons strewn over a square is smaller than the square by (n - 1) / (n + 1) each way.
    float count = float(loadTreeNode(id).count);
    float area = max(n.x * extent.y * extent.z + n.y * extent.x * extent.z + n.z * extent.x * extent.y, 1e-20) *
                 square((count + 1.0) / (count - 1.0));
    bool flat_ = resultant > 0.8 * s.weight && dot(n, extent) < 0.5 * longest; // half angle of a uniform cone: 53 degrees
    return PhotonNode(s.position / max(s.weight, 1e-30), normal, longest, area, s.weight / area, flat_, loadTreeNode(id).count);
}

#endif
