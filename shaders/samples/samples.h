// Irradiance samples: where the picture's indirect light is gathered. Shared by runtime/stages/samples.cpp, gather.cpp,
// interpolate.cpp and shaders/**.
#ifndef SHADERS_SAMPLES_H
#define SHADERS_SAMPLES_H
#include "shaders/primary/primary.h"
#include "shaders/tree/tree.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kSamplesGroupSize = 256u;
GPU_CONST uint kGroupLevels = 4u; // levels of the quadtree whose nodes lie within one group's points: 4^4 = 256

// The quadtree stands over a square grid of points, every stride-th pixel each way, in Z-order: the children of a node are
// four neighbours, so that level sums need no sort. Level 0 is the points; level l has 4^(levels - l) nodes.
struct SamplePoint // a shading point that takes part
{
    vec3 position; // metres
    uint normal;   // octahedral; the smooth one, before the normal map
    uint pixel;    // index of the shading point, kNone: background, outside of the picture, or nothing diffuse there
};
GPU_SIZE(SamplePoint, 20);

struct QuadNode // sums over the points of a node
{
    vec3 position;
    uint count;
    vec3 normal;
    uint variation; // sum of eps(point, node) (Eq. 2) in units of 1 / SeedParams.variation_scale
};
GPU_SIZE(QuadNode, 32);

struct Cluster
{
    vec3 position; // of its centre, metres
    uint normal;
};
GPU_SIZE(Cluster, 16);

struct ClusterSums // fixed-point, so that the sum does not depend on the order of threads
{
    uvec3
        position; // from the cluster's centre, in a cube as wide as it is far from the viewer: units of 1 / ClusterParams.fixed_scale
    uint count;
    uvec3 normal;   // (n + 1) / 2 in the same units
    uint distance;  // of the points to the centre, in units of 1 / fixed_scale of that width
    uint least_eps; // bits of the least eps of its points
    uint nearest;   // index of the point of least eps
};
GPU_SIZE(ClusterSums, 40);

struct Sample
{
    vec3 position; // metres; of a shading point
    uint normal;
    vec3 irradiance;              // W/m^2, indirect only
    float support;                // metres: influence radius
    float harmonic_mean_distance; // metres: harmonic mean distance of its rays' first hits
    uint pixel;
};
GPU_SIZE(Sample, 40);

struct PointParams
{
    uint width; // pixels
    uint height;
    uint stride; // pixels between points
    uint seed;
};
GPU_SIZE(PointParams, 16);

struct SeedParams
{
    uint level;
    uint last_level; // one group works on all from `level` to this one; more groups on one level alone, which is both
    uint levels;
    uint budget; // of the root
    uint seed;
    float alpha; // of Eq. 2, per view distance
    float variation_scale;
    uint uniform_; // 1: budget follows the number of points, not their variation
};
GPU_SIZE(SeedParams, 32);

struct ClusterParams
{
    uint point_count;
    float alpha; // of Eq. 2, per view distance
    float fixed_scale;
    float reach; // support of a sample, in mean distances of its cluster's points to their centre
};
GPU_SIZE(ClusterParams, 16);

// No variation counts more in the quadtree's sums, which are fixed-point: positions count for ten times what normals can.
GPU_CONST float kMostVariation = 20.0f;

GPU_NAMESPACE_END
#endif
