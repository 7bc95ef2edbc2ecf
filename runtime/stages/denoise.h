// Denoising: filters light that was estimated with a ray or two a pixel over pixels of the same surface.
#pragma once
#include "runtime/stages/signals.h"
#include "shaders/denoise/denoise.h"

class DenoiseStage
{
public:
    DenoiseStage(const Device& device, uint32_t max_pixels, const Scratch& scratch = {});

    struct Input
    {
        const Buffer& signal;   // gpu::LightSignal[width * height]
        const Buffer& guides;   // gpu::SurfaceGuide[width * height]
        uint32_t width, height; // pixels
        uint32_t passes;        // each reaches three times as far as the one before, the first to the neighbours
        float pixel_angle;      // radians from a pixel to the next
    };
    /// @return the filtered signal, until the next record(); without passes the signal itself
    const Buffer& record(Recorder& rec, const Input& in) const;

private:
    Kernel filter_;
    std::array<Buffer, 2> filtered_;
};
