// A frame's cameras, seeds and numbers.
#pragma once
#include "runtime/frame/light_range.h"
#include "shaders/primary/primary.h"

#include <optional>

struct FrameInfo
{
    gpu::CameraParams camera; // its first_sample is `accumulated`; its seed is that of all frames of a static view
    std::optional<gpu::CameraParams> before;   // of the last frame, if this one shows something else
    std::optional<gpu::CameraParams> previous; // the same, if this one may reuse its results
    std::optional<LightRange> light_range;     // of that frame's light to this one's, where light has changed since
    bool lights_alone = false;                 // nothing else of the scene has changed since
    uint32_t map_seed = 0;                     // of photon maps, the same in all frames that may share one
    uint32_t number = 0;                       // frames that the renderer recorded before
    uint32_t accumulated = 0;                  // frames accumulated in the static view so far

    bool stands() const { return accumulated > 0; }
};
