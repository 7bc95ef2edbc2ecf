// From samples to a picture: accumulation in 32 bits, then exposure and display transform.
#pragma once
#include "runtime/gpu/gpu.h"
#include "shaders/resolve/resolve.h"

enum class Tonemap : uint32_t
{
    kSrgb = gpu::kTonemapSrgb,
    kAces = gpu::kTonemapAces,
    kAgx = gpu::kTonemapAgx
};

class ResolveStage
{
public:
    ResolveStage(const Device& device, uint32_t max_pixels);

    /// Forgets every sample: the camera or the scene has changed.
    void restart(Recorder& rec);
    /// Adds `sample_count` samples a pixel. @param radiance vec3[sample_count * pixel_count], W/(m^2 sr)
    void accumulate(Recorder& rec, const Buffer& radiance, uint32_t pixel_count, uint32_t sample_count);
    /// @param exposure in stops. @return packed 8-bit sRGB pixels, uint[pixel_count], RGBA or BGRA in memory order
    const Buffer& display(Recorder& rec, uint32_t pixel_count, float exposure, Tonemap tonemap, bool bgra);
    /// The same of another picture. @param picture vec3[pixel_count], of which `scale` times is shown
    const Buffer& display(Recorder& rec, const Buffer& picture, float scale, uint32_t pixel_count, float exposure,
                          Tonemap tonemap, bool bgra);
    /// The same of colours that are for the display as they are. @param colors vec3[pixel_count], linear
    const Buffer& displayColors(Recorder& rec, const Buffer& colors, uint32_t pixel_count, bool bgra)
    {
        return display(rec, colors, 1, pixel_count, 0, Tonemap::kSrgb, bgra);
    }

    const Buffer& sum() const { return sum_; } // vec3[pixel_count]
    uint32_t sampleCount() const { return sample_count_; }
    const Buffer& nonFiniteCount() const
    {
        return non_finite_;
    } // uint: samples left out because they were NaN or infinite

private:
    Kernel accumulate_, tonemap_;
    Buffer sum_, compensation_, non_finite_, pixels_;
    uint32_t sample_count_ = 0;
};
