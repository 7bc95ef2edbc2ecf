// The reference: an unbiased progressive path tracer in wavefronts.
#pragma once
#include "runtime/stages/rays.h"
#include "shaders/lib/terms.h"
#include "shaders/reference/reference.h"

class ReferenceStage
{
public:
    /// @param max_pixels of a picture, @param max_batch samples a pixel taken side by side in one pass
    ReferenceStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels, uint32_t max_batch);

    struct Input
    {
        gpu::CameraParams camera;      // sample_count <= max_batch, first_sample: how many the pixels have had
        uint32_t depth_limit;          // most vertices of a path; the rest of the light is lost
        uint32_t term = gpu::kTermAll; // kTerm*: the paths whose light is kept
        bool emission = true;          // what the eye sees shine is kept, too
    };
    /// Traces camera.sample_count paths a pixel.
    /// @return radiance of this pass alone: vec3[sample_count * width * height]
    const Buffer& record(Recorder& rec, const RayStage& rays, const Input& in) const;

    struct LeftInput
    {
        const RayQueue& rays; // one a path, path = its index; closed, and overwritten
        uint32_t path_count;  // room for results: no path of the queue is greater
        uint32_t depth_limit;
        uint32_t seed;
    };
    /// Traces paths that have just left a surface through its diffuse lobe, along given rays.
    /// @return radiance that is indirect light there: kTermIndirect for an x with a white diffuse lobe. vec3[path_count]
    const Buffer& recordLeft(Recorder& rec, const RayStage& rays, const LeftInput& in) const;

private:
    /// @param params all but the depth
    void follow(Recorder& rec, const RayStage& rays, const RayQueue& first, gpu::ShadeParams params) const;

    Kernel generate_, shade_;
    RayQueue queue_, next_queue_;
    Buffer hits_, states_, radiance_, shadow_size_, shadow_rays_;
};
