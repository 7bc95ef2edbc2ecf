// Which clusters of lamps each part of the picture sees, told by a few shadow rays from every tile to every cluster.
#pragma once
#include "runtime/light_groups.h"
#include "runtime/scene_gpu.h"
#include "shaders/direct/survey.h"

class LightSurvey
{
public:
    /// @param most_clusters that a record() has, @param path_count shading points of a pixel, at most
    LightSurvey(const Device& device, const SceneGpu& scene, uint32_t most_clusters, uint32_t width, uint32_t height,
                uint32_t path_count, const Scratch& scratch);
    /// Scratch memory that it takes, bytes.
    static uint64_t scratchBytes(uint32_t most_clusters, uint32_t width, uint32_t height, uint32_t path_count);

    struct Input
    {
        const Buffer& points; // gpu::ShadingPoint[point_count]
        uint32_t point_count;
        const Buffer& clusters;                // gpu::LightCluster[]
        const Buffer& picks;                   // gpu::LightPick[]
        uint32_t first_cluster, cluster_count; // above 0
        uint32_t extended;                     // bit i: cluster i has lamps with an area
        uint32_t first_sample;
        uint32_t seed;
        const Buffer& shadow_count; // gpu::QueueSize, grows by its rays where
        bool counts_rays;
    };
    /// @return gpu::TileLights[], tiles of gpu::kSurveySide pixels from left to right and down, those of each path of a pixel
    const Buffer& record(Recorder& rec, const Input& in) const;

private:
    const Device& device_;
    const SceneGpu& scene_;
    uint32_t width_, height_, tile_count_;
    Kernel survey_, tally_, divide_;
    Buffer arrived_, sums_, tiles_;
};
