// Guided emission of photons. Shared by runtime/stages/guide.cpp, lib/emission.glsl and shaders/**.
#ifndef SHADERS_GUIDE_H
#define SHADERS_GUIDE_H
#include "shaders/photons/photons.h"

GPU_NAMESPACE_BEGIN

// The emission space is divided into groups of cells: each directional or environment light, whose photons start on a plane as wide
// as the scene, is a group whose cells divide that plane, smaller ones near the viewer (lib/emission.glsl). All other lights
// together are the last group, whose cells divide their power. Before anything is learned, groups are equally likely, because the
// power of a directional light does not tell how much of it is visible, and so are the cells of each.
GPU_CONST uint kGuideSide = 32u;
GPU_CONST uint kGuideCells = kGuideSide * kGuideSide;    // of a group
GPU_CONST uint kGuideInfiniteLights = 7u;                // that have a group of their own at most
GPU_CONST uint kGuideGroups = kGuideInfiniteLights + 1u; // the last is that of the other lights
GPU_CONST uint kGuideTotal = kGuideGroups * kGuideCells;
GPU_CONST uint kGuideVoxels = 64u; // each way, over the grid of lib/morton.glsl
GPU_CONST uint kGuideSides = 6u;   // of a voxel: the two sides of a thin wall differ in importance
GPU_CONST uint kGuideBins = kGuideSides * kGuideVoxels * kGuideVoxels * kGuideVoxels;
GPU_CONST uint kGuideSplatStride = 4u;       // one of this many gathering rays is splatted
GPU_CONST uint kGuideMostImportance = 1023u; // largest importance of a place, rays
GPU_CONST uint kGuideGroupSize = 64u;
GPU_CONST uint kGuideLearnSize = 256u;

GPU_CONST float kGuideUnguided =
    0.2f; // fraction of the photons that is emitted without guiding, which bounds the weights
GPU_CONST float kGuideSpread = 0.5f;  // fraction of what was learned of a cell that is spread over those around it
GPU_CONST float kGuideMemory = 0.75f; // weight of what was learned before, a frame

struct GuideGroups // which lights they are, fixed for a scene, and how likely, which follows their power
{
    uint infinite_lights[kGuideInfiniteLights]; // light index; kNone: no such group
    float shares[kGuideGroups];                 // of all power
    float unlearned[kGuideGroups]; // probability that a photon leaves by the group where nothing was learned
};
GPU_SIZE(GuideGroups, 92);

struct GuideEstimate // of the square of what a cell's paths give the picture
{
    uint low, high; // sum over this frame's paths, 64 bits of fixed point in units of the square of the largest
    float before;   // fading sum over the frames
};
GPU_SIZE(GuideEstimate, 12);

struct GuideDistribution // of emission, learned
{
    float groups[kGuideGroups]; // probability of a group and those before it
    float
        cells[kGuideTotal]; // within its group, cumulative probability of its cells: more precise than over all groups
};
GPU_SIZE(GuideDistribution, 32800);

struct EstimateParams
{
    float scale; // of the fixed-point estimates
};
GPU_SIZE(EstimateParams, 4);

struct FadeParams
{
    float memory; // weight of what was learned before
    float scale;  // of the fixed-point estimates
};
GPU_SIZE(FadeParams, 8);

GPU_NAMESPACE_END
#endif
