// Interpolation: indirect diffuse light at every pixel from the samples around its shading point.
#pragma once
#include "runtime/stages/samples.h"
#include "shaders/interpolate/interpolate.h"

class InterpolateStage
{
public:
    InterpolateStage(const Device& device, uint32_t max_samples, uint32_t max_points);

    struct Input
    {
        const Buffer& diffuse_points; // gpu::DiffusePoint[point_count]
        const Buffer& radiance;       // vec3[point_count], grows by the indirect diffuse light
        uint32_t point_count;
        uint32_t width;     // of the picture, pixels
        float alpha;        // of Eq. 2, per view distance, where no sample is accepted
        bool white = false; // as if every surface reflected all of it and nothing else had been: a debug view
    };
    struct View
    {
        const Buffer& points; // gpu::ShadingPoint[point_count]
        uint32_t point_count;
        uint32_t width;            // of the picture, pixels
        bool by_direction = false; // whether GlossyStage::recordHarmonics() follows
    };
    struct Sorted // samples as pixels look them up
    {
        const Buffer& size;    // gpu::QueueSize
        const Tree& tree;      // over their supports; its order() leads back to where they were gathered
        const Buffer& samples; // gpu::SampleTexels[size.count], sorted as the tree
        // Of each group of kRaysGroupSize threads that take pixels by tiledPixel(): samples whose support reaches into it.
        const Buffer& nearby;        // uint[groups * gpu::kNearbySamples]
        const Buffer& nearby_counts; // uint[groups]; gpu::kNone: they are too many
    };
    /// Sorts samples that have been gathered, and finds those near each group of the view's pixels.
    Sorted sort(Recorder& rec, const SamplesStage::Output& samples, const View& view) const;
    void record(Recorder& rec, const Sorted& sorted, const Input& in) const;

    const Buffer& statistics() const { return statistics_; } // gpu::InterpolateStatistics of the last frame

private:
    Kernel reorder_, nearby_kernel_;
    uint32_t run_; // pixels a thread
    Kernel apply_;
    Tree tree_;
    Buffer sorted_, nearby_, nearby_counts_, statistics_;
};
