// Direct light at the shading points: shadow rays to sampled lights, combined with BSDF-sampled rays.
#pragma once
#include "runtime/stages/rays.h"
#include "shaders/direct/direct.h"

class DirectStage
{
public:
    DirectStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels);

    struct Input
    {
        const Buffer& points;   // gpu::ShadingPoint[point_count]
        const Buffer& radiance; // vec3[point_count], grows by the direct light
        uint32_t point_count;
        uint32_t light_sample_count; // per point
        uint32_t first_sample;
        uint32_t seed;
    };
    void record(Recorder& rec, const RayStage& rays, const Input& in) const;

private:
    Kernel sample_, emitted_;
    RayQueue emitter_queue_;
    Buffer shadow_size_, shadow_rays_, emitter_rays_, hits_;
    bool has_area_lights_;
};
