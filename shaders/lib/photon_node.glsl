// Estimates of the light around a node of the photon tree. The kernel declares `buffer Size`,
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
    return PhotonSums(photon.power, weight, weight * photon.position, weight * weight, unpackNormal(photon.normal),
                      photon.position, vec3(0.0), vec3(0.0));
}

/// The sums of two nodes of a and b photons together; of spreads about the means (Chan et al. 1979).
PhotonSums joined(PhotonSums a, uint a_count, PhotonSums b, uint b_count)
{
    float total = float(a_count + b_count), share = float(b_count) / total;
    vec3 d = b.mean - a.mean;
    float between = float(a_count) * share;
    return PhotonSums(a.power + b.power, a.weight + b.weight, a.position + b.position, a.squares + b.squares,
                      a.normal + b.normal, a.mean + share * d, a.spread + b.spread + between * d * d,
                      a.spread_off + b.spread_off + between * vec3(d.x * d.y, d.x * d.z, d.y * d.z));
}

/// Photons of a node that is not divided further.
uint fewestPhotons(CutParams params) { return max(params.fewest, size.count / params.most_nodes); }

struct PhotonNode
{
    vec3 center;      // metres: power-weighted mean of its photons
    vec3 normal;      // unit
    float longest;    // metres: about the longer side of what its photons lie on; 0 for a single one
    float area;       // square metres: that its photons lie on; 0 for fewer than three, which do not determine it
    float irradiance; // luminance of E~
    float noise2;     // square of the relative standard error of E~
    bool flat_;       // its photons lie near one plane and face one way: E~ means something
    uint count;       // photons
};

/// Every photon of a node that faces one way faces within this of the mean normal, as 1 - cosine: 45 degrees.
const float kFacingApart = 0.3;
/// Variance of the photons of a flat node across their plane, in that along it: a node over two shelves is not flat where
/// these lie 0.1 of its size apart.
const float kBent = 0.02;
const uint kFewestCompared = 4u; // photons whose area means something

/// v^T M v and v^T adj(M) v of a symmetric matrix: variance along v, and determinant of what is across it.
vec2 alongAndAcross(vec3 diagonal, vec3 off, vec3 v)
{
    vec3 rows = vec3(dot(vec3(diagonal.x, off.x, off.y), v), dot(vec3(off.x, diagonal.y, off.z), v), dot(vec3(off.y, off.z, diagonal.z), v));
    vec3 adjugate = diagonal.yxx * diagonal.zzy - square(off.zyx);
    vec3 adjugate_off = vec3(off.y * off.z - off.x * diagonal.z, off.x * off.z - off.y * diagonal.y, off.x * off.y - off.z * diagonal.x);
    float across = dot(adjugate, v * v) + 2.0 * dot(adjugate_off, vec3(v.x * v.y, v.x * v.z, v.y * v.z));
    return vec2(dot(rows, v), across);
}

PhotonNode photonNode(uint id)
{
    if (isPhoton(id))
        return PhotonNode(loadPhoton(id + 1u - size.count).position, unpackNormal(loadPhoton(id + 1u - size.count).normal), 0.0, 0.0, 0.0, 1.0, true, 1u);
    PhotonSums s = sums[id];
    uint count = loadTreeNode(id).count;
    float n = float(count), resultant = length(s.normal);
    vec3 normal = resultant > 0.0 ? s.normal / resultant : vec3(0.0, 0.0, 1.0);
    vec2 plane = alongAndAcross(s.spread, s.spread_off, normal);
    float along = max(plane.x, 0.0) / n, across = max(s.spread.x + s.spread.y + s.spread.z - plane.x, 0.0) / n;
    // Of a rectangle a x b the variances are a^2 / 12 and b^2 / 12 whatever its orientation, of a disc nearly the same; the
    // expected determinant of n points' sums is (n - 1)(n - 2) times that of the covariances.
    float area = count < 3u ? 0.0 : 12.0 * sqrt(max(plane.y, 0.0) / ((n - 1.0) * (n - 2.0)));
    // The sum over photons of 1 - cosine to the mean normal bounds that of every one.
    bool flat_ = n - resultant <= kFacingApart && along <= kBent * across;
    float noise2 = s.squares / max(square(s.weight), 1e-30) + 1.0 / n;
    return PhotonNode(s.position / max(s.weight, 1e-30), normal, sqrt(6.0 * across), area, s.weight / max(area, 1e-20),
                      noise2, flat_, count);
}

const float kBeyondChance = 3.0; // standard errors: one even node of four hundred is taken for an uneven one

/// Whether photons lie more densely in one half of a node than in the other, beyond chance and beyond what is let pass: an edge
/// of light and shadow runs through it, or a part of it has no surface.
/// @param difference that is let pass, relative to the larger E~
bool isUneven(uint id, PhotonNode node, float difference)
{
    PhotonNode a = photonNode(childId(loadTreeNode(id).left)), b = photonNode(childId(loadTreeNode(id).right));
    if (a.count < b.count)
    {
        PhotonNode larger = b;
        b = a;
        a = larger;
    }
    if (b.count < kFewestCompared) // too few for an area: they count by what they add to the node's
        b = node;
    float chance = kBeyondChance * sqrt(square(a.irradiance) * a.noise2 + square(b.irradiance) * b.noise2);
    return abs(a.irradiance - b.irradiance) > max(difference * max(a.irradiance, b.irradiance), chance);
}

#endif
