// What a frame knows of itself and of the one before it.
#pragma once
#include "shaders/primary/primary.h"

#include <optional>

struct FrameInfo
{
    gpu::CameraParams camera;                  // its first_sample is `accumulated`; its seed serves all frames of a standing picture
    std::optional<gpu::CameraParams> previous; // of the last frame, where what that one found may serve in this one
    uint32_t map_seed = 0;                     // of photon maps, the same in all frames that may share one
    uint32_t number = 0;                       // frames that the renderer recorded before
    uint32_t accumulated = 0;                  // frames that the standing picture is the mean of already

    bool stands() const { return accumulated > 0; }
};
