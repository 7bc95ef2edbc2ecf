// Indirect light in rough mirrors: rays by the specular lobe that read the illumination cut where they end. What comes
// from the samples' spherical harmonics needs no ray.
#pragma once
#include "runtime/stages/cut.h"
#include "runtime/stages/interpolate.h"
#include "runtime/stages/rays.h"
#include "shaders/glossy/glossy.h"

class GlossyStage
{
public:
    GlossyStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels, const Scratch& scratch = {});

    struct Input
    {
        const Buffer& points;   // gpu::ShadingPoint[point_count]
        const Buffer& radiance; // vec3[point_count], grows by the glossy light
        uint32_t point_count;
        uint32_t width; // of the picture, pixels
        uint32_t first_sample;
        uint32_t specular_depth; // most delta events of a ray
        uint32_t seed;
        float
            roulette_threshold; // Russian-roulette threshold: surfaces that reflect less trace a ray from some of their pixels
        bool shared = false; // whether recordHarmonics() has computed a part of the light
    };
    void record(Recorder& rec, const RayStage& rays, const CutStage::Output& cut, const Input& in) const;

    /// Adds what rough lobes reflect by the samples' harmonics; record() with in.shared then adds the rest.
    /// @param harmonics gpu::SampleHarmonics, by sample as gathered
    void recordHarmonics(Recorder& rec, const InterpolateStage::Sorted& samples, const Buffer& harmonics,
                         const Input& in) const;

private:
    Kernel generate_, shade_, harmonics_;
    RayQueue queue_;
    Buffer hits_, states_, lobes_, shares_;
};
