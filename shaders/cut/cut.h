// The illumination cut through the photon tree. Shared by runtime/stages/cut.cpp, lib/cut.glsl and shaders/**.
#ifndef SHADERS_CUT_H
#define SHADERS_CUT_H
#include "shaders/lib/choice.h"
#include "shaders/photons/photons.h"
#include "shaders/tree/tree.h"

GPU_NAMESPACE_BEGIN

// A node of the photon tree by id: inner node i is i, photon i of n is n - 1 + i. There are 2 n - 1.

struct PhotonSums // over the photons of an inner node
{
    vec3 power;       // watts
    float weight;     // sum of luminances
    vec3 normal;      // luminance-weighted sum of the photons' normals
    vec3 position;    // likewise of their positions
};
GPU_SIZE(PhotonSums, 40);

struct CutNode // one node of the cut: what light falls on the surface around its centre
{
    vec3 center;     // metres: power-weighted mean of its photons
    float support;   // metres: how far from the centre it counts
    vec3 irradiance; // W/m^2: what its photons give at its centre, falling to 0 at its support; E_p in mode kCutNearest
    uint normal;     // octahedral
};
GPU_SIZE(CutNode, 32);

struct CutThreshold // made on the GPU each time the cut is built
{
    float irradiance; // E_min: mean luminance of E~ over the tree's level of about 4096 nodes
    uint padding;
};
GPU_SIZE(CutThreshold, 8);

struct PartialMean
{
    float sum;
    uint count;
};
GPU_SIZE(PartialMean, 8);

#define GPU_CUT_MODES(X) \
    X(kCutKnn, 0u, "knn")         /* no cut: density estimation at every gather hit */ \
    X(kCutNearest, 1u, "nearest") /* the refined cut, read at its nearest node */ \
    X(kCutLeaves, 2u, "leaves")   /* the finest cut: nodes of a few photons at most */ \
    X(kCutRefined, 3u, "refined") /* Algorithm 3 */
GPU_CUT_MODES(GPU_CHOICE_CONSTANT)

GPU_CONST uint kCutGroupSize = 64u;
GPU_CONST uint kPartialMeans = 64u;   // groups that sum E~
GPU_CONST uint kPartialGroupSize = 256u;
GPU_CONST uint kCutLevelNodes = 4096u; // nodes of the level that E_min is taken from
GPU_CONST uint kCutFewest = 8u;        // photons of a node that say something of their density

// A node's support in radii of density estimation: wider is smoother and slower, narrower sharper. 0.7 to 1 are near the
// best in all scenes.
GPU_CONST float kCutSpread = 0.8f;
GPU_CONST uint kCutProbeCapacity = 1u << 20u; // rays that feel for surfaces, of all nodes
GPU_CONST float kMostUncovered = 8.0f;        // a node's light grows no more than this

struct RepresentParams
{
    uint seed;
};
GPU_SIZE(RepresentParams, 4);

struct ProbeParams
{
    uint ray_count; // that a node wants
    uint seed;
};
GPU_SIZE(ProbeParams, 8);

struct CutParams
{
    uint mode;         // kCut*
    uint last;         // 1: every node that is left becomes final
    float difference;  // Delta_E: relative difference that is let pass
    uint photon_count; // k of the density estimation
    float radius;      // metres, of the density estimation at most
    float spread;      // a node's support, in radii of the density estimation at its centre
    uint fewest;       // photons of a node that is not divided further
    uint most_nodes;   // that there are probes for: the more photons, the more of them share a node
};
GPU_SIZE(CutParams, 32);

GPU_NAMESPACE_END
#endif
