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
    vec3 power;      // watts
    float weight;    // sum of luminances
    vec3 position;   // luminance-weighted sum of the photons' positions
    float squares;   // sum of squared luminances
    vec3 normal;     // sum of the photons' normals, unweighted: weighted by power, a bright photon would hide dim ones
    vec3 mean;       // of their positions, unweighted
    vec3 spread;     // sums of xx, yy, zz of their positions from the mean
    vec3 spread_off; // likewise of xy, xz, yz
};
GPU_SIZE(PhotonSums, 80);

struct CutNode // one node of the cut: what light falls on the surface around its centre
{
    vec3 center;     // metres: power-weighted mean of its photons
    float support;   // metres: influence radius
    vec3 irradiance; // W/m^2: what its photons give at its centre, falling to 0 at its support; E_p in mode kCutNearest
    uint normal_and_eye; // see lib/cut_node.glsl
};
GPU_SIZE(CutNode, 32);

#define GPU_CUT_MODES(X) \
    X(kCutKnn, 0u, "knn")         /* no cut: density estimation at every gather hit */ \
    X(kCutNearest, 1u, "nearest") /* the refined cut, read at its nearest node */ \
    X(kCutLeaves, 2u, "leaves")   /* the finest cut: nodes of a few photons at most */ \
    X(kCutRefined, 3u, "refined") /* Algorithm 3 */
GPU_CUT_MODES(GPU_CHOICE_CONSTANT)

GPU_CONST uint kCutGroupSize = 64u;
GPU_CONST uint kCutFewest = 8u; // photons from which a density can be estimated
// Of the photons of a density estimate a node of the refined cut holds this many times as many at most: larger ones blur more
// than the estimate would (a box of white walls read 2 % too dark where nodes were as large as chance allowed).
GPU_CONST uint kCutMost = 2u;

// A node's support in radii of density estimation: wider is smoother and slower, narrower sharper. 0.7 to 1 are near the
// best in all scenes.
GPU_CONST float kCutSpread = 0.8f;
GPU_CONST uint kCutProbeCapacity = 1u << 20u; // coverage probe rays of all nodes

// From how high above its centre a node's disc is seen, in supports, unless something is in the way: high enough that rays
// to the rim pass over a bumpy floor, low enough that they do not pass over a wall.
GPU_CONST float kProbeHeight = 0.2f;

// CutNode.normal_and_eye: octahedral normal, 12 bits a coordinate (snorm), the eye's height in units of kProbeHeight supports / 127,
// 7 bits, 0 where the disc is seen from infinitely far; and kCutIsClear.
GPU_CONST uint kCutNormalBits = 12u;
GPU_CONST uint kCutEyeSteps = 127u;
GPU_CONST uint kCutIsClear =
    0x80000000u; // all of the disc is on the surface and visible: a lookup needs no visibility ray

struct SampleDirectionParams
{
    uint seed;
    uint is_probed; // 1: discs are seen from somewhere; 0: all of them are
};
GPU_SIZE(SampleDirectionParams, 8);

// A node's probe rays are the work of so many threads together.
GPU_CONST uint kProbeThreads = 32u;
GPU_CONST uint kMostProbes = 128u; // of a node, those to its rim included

struct ProbeParams
{
    uint ray_count; // of a node
    uint rim_count; // additional rays to the rim of its disc: if all arrive, nothing stands on it
    uint seed;
};
GPU_SIZE(ProbeParams, 12);

struct CutParams
{
    uint mode;         // kCut*
    uint last;         // 1: every node that is left becomes final
    float difference;  // Delta_E: relative difference that is let pass
    uint photon_count; // k of the density estimation
    float radius;      // of the density estimation at most: of the distance from the viewer
    float spread;      // a node's support, in radii of the density estimation at its centre
    uint fewest;       // photons of a node that is not divided further
    uint most_nodes;   // for which there are probe rays: with more photons, nodes hold more of them
};
GPU_SIZE(CutParams, 32);

GPU_NAMESPACE_END
#endif
