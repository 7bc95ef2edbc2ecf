// Irradiance samples: adaptive seeding over a quadtree of the picture (Algorithm 1), k-means clustering (Algorithm 2).
#pragma once
#include "runtime/choices.h"
#include "runtime/stages/rays.h"
#include "runtime/stages/tree.h"
#include "shaders/samples/samples.h"

class SamplesStage
{
public:
    SamplesStage(const Device& device, uint32_t width, uint32_t height, uint32_t max_samples);

    struct Input
    {
        const Buffer& diffuse_points; // gpu::DiffusePoint[width * height]
        SamplesMode mode;
        uint32_t budget;     // samples, <= max_samples
        uint32_t iterations; // of k-means
        float alpha;         // of Eq. 2, per view distance
        float reach;         // of a sample, in mean distances of its cluster's points to their centre
        uint32_t seed;
    };
    struct Output
    {
        const Buffer& size;    // gpu::QueueSize: samples
        const Buffer& samples; // gpu::Sample[size.count], irradiance still to be gathered
        const Buffer& spheres; // vec4[size.count]: their positions and supports
    };
    Output record(Recorder& rec, const RayStage& rays, const Input& in) const;
    /// What the last record() left.
    Output output() const { return {.size = size_, .samples = samples_, .spheres = spheres_}; }

    struct Quadtree // how the samples came about
    {
        uint32_t stride;       // pixels between neighbouring points, each way
        uint32_t levels;       // points are level 0
        const Buffer& budgets; // uint[], by node as samples/quadtree.glsl orders them: samples that it was to get
        const Buffer& owners;  // uvec2[], by point in Z-order: its cluster or kNone; bits of its eps
    };
    Quadtree quadtree() const { return {.stride = stride_, .levels = levels_, .budgets = budgets_, .owners = owners_}; }

    /// The samples of the last record(); waits for the device.
    std::vector<gpu::Sample> download(const Device& device) const
    {
        return device.download<gpu::Sample>(samples_, device.download<gpu::QueueSize>(size_, 1)[0].count);
    }

    /// Pixels between neighbouring points of the quadtree, each way.
    uint32_t stride() const { return stride_; }

private:
    void recordSeeds(Recorder& rec, const RayStage& rays, const Input& in) const;
    void recordClusters(Recorder& rec, const Input& in, const gpu::ClusterParams& params) const;
    void assign(Recorder& rec, const gpu::ClusterParams& params) const;

    uint32_t width_, height_;
    uint32_t stride_, levels_;
    uint32_t grid_count_,
        point_count_; // points of the quadtree's square; the first of them that hold all of the picture
    Kernel points_kernel_, mean_, variation_, budget_, seed_, assign_, update_, snap_, occupied_kernel_, place_;
    Compaction seed_compaction_, sample_compaction_;
    Tree tree_;
    Buffer point_size_, points_, quad_nodes_, budgets_, seed_flags_, seeds_;
    Buffer cluster_size_, clusters_, cluster_spheres_, sums_, owners_, occupied_flags_, occupied_;
    Buffer size_, samples_, spheres_;
};
