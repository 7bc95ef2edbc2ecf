// Denoising: spreads light that pixels know from a random ray or two over those that see the same surface.
#pragma once
#include "runtime/gpu/recorder.h"
#include "runtime/scene_gpu.h"
#include "shaders/denoise/denoise.h"

class DenoiseStage
{
public:
    DenoiseStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels);

    struct Input
    {
        const Buffer& points;   // gpu::ShadingPoint[width * height]
        const Buffer& light;    // vec3[width * height]: that is filtered
        uint32_t width, height; // pixels
        uint32_t passes;        // >= 1; each reaches three times as far as the one before, the first to the neighbours
        float pixel_angle;      // radians from a pixel to the next
        bool glossy;            // the light is that of specular lobes alone
    };
    void record(Recorder& rec, const Input& in) const;

private:
    Kernel prepare_, filter_, apply_;
    Buffer guides_, signals_;
    std::array<Buffer, 2> filtered_;
};
