// Indirect light in rough mirrors: rays by the specular lobe that read the illumination cut where they end.
#pragma once
#include "runtime/stages/cut.h"
#include "runtime/stages/rays.h"
#include "shaders/glossy/glossy.h"

class GlossyStage
{
public:
    GlossyStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels);

    struct Input
    {
        const Buffer& points;   // gpu::ShadingPoint[point_count]
        const Buffer& radiance; // vec3[point_count], grows by the glossy light
        uint32_t point_count;
        uint32_t first_sample;
        uint32_t specular_depth; // most delta events of a ray
        float radius;            // metres: how far a cut node may be
        uint32_t seed;
    };
    void record(Recorder& rec, const RayStage& rays, const CutStage::Output& cut, const Input& in) const;

private:
    Kernel generate_, link_;
    RayQueue queue_, next_queue_;
    Buffer hits_, states_;
};
