// A debug view that outlives the frame: how far the accumulated picture is from a reference, as a heat map.
#pragma once
#include "runtime/gpu/gpu.h"
#include "shaders/views/views.h"

#include <span>

class ErrorView
{
public:
    /// @param reference linear radiance, rows from the top, [width * height], each at least 1
    ErrorView(const Device& device, std::span<const gpu::vec3> reference, uint32_t width, uint32_t height,
              uint32_t max_pixels);

    /// @param sum vec3[width * height] of a picture that may have another size than the reference, which is stretched to it
    void record(Recorder& rec, const Buffer& sum, uint32_t sample_count, uint32_t width, uint32_t height) const;
    const Buffer& colors() const { return colors_; } // vec3[max_pixels], linear display-referred

private:
    Kernel error_;
    Buffer reference_, colors_;
    uint32_t reference_width_, reference_height_;
    float floor_;
};
