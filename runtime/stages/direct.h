// Direct light at the shading points: shadow rays to sampled lights, combined with BSDF-sampled rays.
#pragma once
#include "runtime/light_groups.h"
#include "runtime/scene_gpu.h"
#include "runtime/stages/rays.h"
#include "shaders/direct/direct.h"

#include <optional>

class DirectStage
{
public:
    DirectStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels, const Scratch& scratch = {});

    struct Input
    {
        const Buffer& points;   // gpu::ShadingPoint[point_count]
        const Buffer& radiance; // vec3[point_count], grows by the direct light
        const Buffer& noisy;    // likewise, by what is left to chance of it; may be `radiance`
        uint32_t point_count;
        uint32_t light_sample_count; // per point, for directional, environment and local lights each
        uint32_t candidate_count;    // light samples of which one is chosen for the shadow ray
        uint32_t first_sample;
        uint32_t seed;
    };
    void record(Recorder& rec, const RayStage& rays, const Input& in);
    bool isNoisy() const { return is_noisy_; } // otherwise direct light is exact in every frame, whatever lights change

private:
    void followLights(Recorder& rec);
    void recordSample(Recorder& rec, const RayStage& rays, const Input& in, uint32_t light_sample) const;

    const SceneGpu& scene_;
    LightGroups lights_;
    std::optional<uint64_t> table_version_; // that they were made of
    Kernel sample_, emitted_;
    RayQueue emitter_queue_;
    Buffer shadow_size_, shadow_rays_, emitter_rays_, hits_, picks_;
    bool has_area_lights_, is_noisy_;
};
