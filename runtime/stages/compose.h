// The picture of a frame as the sum of its terms.
#pragma once
#include "runtime/frame/light_buffers.h"
#include "runtime/frame/plan.h"

class ComposeStage
{
public:
    ComposeStage(const Device& device, uint32_t max_pixels, const Scratch& scratch = {});

    /// The terms that `plan` shows. @return vec3[pixel_count], W/(m^2 sr), in scratch memory
    const Buffer& record(Recorder& rec, const LightBuffers& light, const FramePlan& plan, uint32_t pixel_count,
                         uint32_t point_count) const;

private:
    Kernel sum_;
    Buffer picture_;
};
