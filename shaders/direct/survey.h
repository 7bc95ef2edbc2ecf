// Which lamps a part of the picture sees: tiles of pixels send a few shadow rays to every cluster of lights. Shared by
// runtime/stages/light_survey.cpp and shaders/direct/*.comp.
#ifndef SHADERS_SURVEY_H
#define SHADERS_SURVEY_H
#include "shaders/primary/primary.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kMostClusters = 16u; // of local lights
GPU_CONST uint kSurveySide = 32u;   // pixels, of a tile
GPU_CONST uint kSurveyRays =
    16u; // a tile and cluster: the fewer, the more clusters that a tile sees a little of are missed

struct LightPick // Walker's alias method within a cluster
{
    uint light; // taken where a second uniform number < threshold
    float threshold;
    uint otherwise; // light taken else
    uint unused;    // whole texels
};
GPU_SIZE(LightPick, 16);

struct LightCluster // lights that are near each other, so that a surface mostly sees all or none of them
{
    uint first_pick; // its part of the picks
    uint pick_count;
    float share;    // of all lights' pmf
    uint strongest; // light of it
};
GPU_SIZE(LightCluster, 16);

// What a tile knows of a cluster: all of its rays have arrived; some have, or some of those of a tile beside; or none. A set's shadow
// ray is its own: what surely arrives adds no noise to what may be hidden, and no lamp behind a wall takes the ray of one that is
// seen. Lamps with an area are not told apart by whether they surely arrive: most of their noise is in where on them a ray ends
// (atrium: LDR-FLIP of direct light 0.119 in place of 0.121 for 0.9 ms of a frame on an H200).
GPU_CONST uint kSureLights = 0u, kSeenLights = 1u, kRestLights = 2u, kLightSets = 3u;

/// What a tile knows of the clusters.
struct TileLights
{
    uint sure;                        // bit i: cluster i is in that set; the others are in the last one
    uint seen;                        // likewise
    uint visible[kMostClusters / 4u]; // the fraction of a seen cluster's light that arrives; four in a word, of 255
    float ends[kMostClusters];        // cumulative probabilities of choosing a cluster of its set, by what arrives
};
GPU_SIZE(TileLights, 88);

struct SurveyParams
{
    uint point_count;
    uint pixel_count; // points of other paths through the same pixel follow, and have tiles of their own
    uint width;       // of the picture, pixels
    uint tile_count;
    uint first_cluster;
    uint cluster_count; // <= kMostClusters
    uint first_sample;
    uint seed;
};
GPU_SIZE(SurveyParams, 32);

struct TallyParams
{
    uint tile_count;
    uint cluster_count;
    uint columns, rows; // of tiles; those of other paths through the same pixels follow
    uint extended;      // bit i: cluster i has lamps with an area
};
GPU_SIZE(TallyParams, 20);

GPU_NAMESPACE_END
#endif
