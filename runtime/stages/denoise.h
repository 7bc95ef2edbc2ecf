// Denoising: spreads light that pixels know from a random ray or two over those that see the same surface.
#pragma once
#include "runtime/gpu/recorder.h"
#include "runtime/scene_gpu.h"
#include "shaders/denoise/denoise.h"

class DenoiseStage
{
public:
    DenoiseStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels);

    /// vec3[max_pixels]: where noisy light is collected, from clear() to record().
    const Buffer& light() const { return light_; }
    void clear(Recorder& rec) const { rec.clear(light_); }

    struct Input
    {
        const Buffer& points;   // gpu::ShadingPoint[width * height]
        const Buffer& radiance; // vec3[width * height], grows by the filtered light
        uint32_t width, height; // pixels
        uint32_t passes;        // >= 1; each reaches three times as far as the one before, the first to the neighbours
        float pixel_angle;      // radians from a pixel to the next
        bool glossy;            // the light is that of specular lobes alone
        const Buffer&
            shares; // float[width * height]: parts of the light that are in `radiance` already; read where `shared`
        bool shared = false;
    };
    void record(Recorder& rec, const Input& in) const;

private:
    Kernel prepare_, filter_, apply_;
    Buffer light_, guides_, signals_;
    std::array<Buffer, 2> filtered_;
};
