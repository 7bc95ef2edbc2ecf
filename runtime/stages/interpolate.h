// Interpolation: indirect diffuse light at every pixel from the samples around its shading point.
#pragma once
#include "runtime/stages/samples.h"
#include "shaders/interpolate/interpolate.h"

class InterpolateStage
{
public:
    InterpolateStage(const Device& device, const SceneGpu& scene, uint32_t max_samples);

    struct Glossy // reflection in rough lobes by the samples' harmonics
    {
        const Buffer& harmonics; // gpu::SampleHarmonics, by sample
        const Buffer& lobes;     // glossyLobes()
        const Buffer& shares;    // float[point_count], becomes the part of the glossy light that is there with it
    };
    struct Input
    {
        const Buffer& points;   // gpu::ShadingPoint[point_count]
        const Buffer& radiance; // vec3[point_count], grows by the indirect diffuse light, and the glossy light by harmonics
        uint32_t point_count;
        float alpha;  // of Eq. 2, per metre, where no sample is accepted
        float radius; // metres: how far a sample may be there
        bool diffuse = true; // else glossy light alone
        bool white = false; // as if every surface reflected all of it and nothing else had been: a debug view
        const Glossy* glossy = nullptr; // none: diffuse light alone
    };
    void record(Recorder& rec, const SamplesStage::Output& samples, const Input& in) const;

    const Buffer& statistics() const { return statistics_; } // gpu::InterpolateStatistics of the last frame

private:
    Kernel reorder_, apply_, apply_glossy_;
    Tree tree_;
    Buffer sorted_, statistics_, unused_; // the last where there is no glossy light
};
