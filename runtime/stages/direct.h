// Direct light at the shading points: shadow rays to sampled lights, combined with BSDF-sampled rays.
#pragma once
#include "runtime/light_groups.h"
#include "runtime/stages/light_survey.h"
#include "runtime/stages/rays.h"
#include "shaders/direct/direct.h"

#include <optional>

/// Around all lights that a ray may find, metres.
struct EmitterBox
{
    gpu::vec3 low, high;
};
EmitterBox emitterBox(const SceneGpu& scene);

class DirectStage
{
public:
    /// @param path_count shading points of a pixel, at most
    DirectStage(const Device& device, const SceneGpu& scene, uint32_t width, uint32_t height, uint32_t path_count,
                const Scratch& scratch = {});
    /// Scratch memory that it takes, bytes, but for what aligning its buffers costs.
    static uint64_t scratchBytes(const SceneGpu& scene, uint32_t width, uint32_t height, uint32_t path_count);

    struct Input
    {
        const Buffer& points;   // gpu::ShadingPoint[point_count]
        const Buffer& radiance; // vec3[point_count], grows by the direct light
        const Buffer& noisy;    // likewise, by what is left to chance of it; may be `radiance`
        uint32_t point_count;
        uint32_t light_sample_count; // per point, for directional, environment and local lights each (each set of them)
        uint32_t candidate_count;    // light samples of which one is chosen for the shadow ray, about
        uint32_t first_sample;
        uint32_t seed;
    };
    void record(Recorder& rec, const RayStage& rays, const Input& in);
    /// By what factor the light of `noisy` has changed since the last frame because the eye has moved. Call it after record().
    /// @param points gpu::ShadingPoint[at least width * height]
    /// @return float[width * height]; null where that is 1 everywhere, or lamps are not all that there is
    const Buffer* recordHighlights(Recorder& rec, const Buffer& points, const gpu::CameraParams& last_camera) const;
    bool isNoisy() const { return is_noisy_; } // otherwise direct light is exact in every frame, whatever lights change

private:
    void followLights(Recorder& rec);
    Kernel sampleKernel(bool knows_seen, bool counts_rays) const;
    /// @param tiles gpu::TileLights[]
    void recordSample(Recorder& rec, const RayStage& rays, const Input& in, uint32_t light_sample,
                      const Buffer& tiles) const;

    const Device& device_;
    const SceneGpu& scene_;
    std::vector<uint32_t> clusters_of_; // by light
    LightGroups lights_;
    std::optional<uint64_t> table_version_; // that they were made of
    uint32_t width_, height_;
    EmitterBox emitters_;
    Kernel sample_, sample_seen_, emitted_; // sample_seen_: of lamps in several clusters
    Buffer shadow_count_;                   // gpu::QueueSize: rays that its kernels have traced, where rays are counted
    RayQueue emitter_queue_;
    Buffer emitter_rays_, hits_, clusters_, picks_, densities_, no_tiles_;
    std::optional<LightSurvey> survey_; // where there are several clusters
    std::optional<Kernel> highlights_;  // where surfaces can have any of lamps
    Buffer factors_;
    const Buffer* tiles_ = nullptr; // of the last record()
    bool has_area_lights_, is_noisy_;
};
