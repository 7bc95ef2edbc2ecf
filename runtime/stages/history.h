// What pixels remember: while the picture moves, light is the mean of this frame's and of what the same surface showed before.
#pragma once
#include "runtime/stages/signals.h"
#include "shaders/history/history.h"

class HistoryStage
{
public:
    HistoryStage(const Device& device, uint32_t max_pixels);

    struct Input
    {
        const SignalBuffers& signals; // their light becomes the mean
        const SurfaceBuffers& surface;
        const LightBuffers& light; // so do its indirect light and caustics
        const FrameInfo& frame;    // frame.previous: record() was called for it, too
        uint32_t most_frames;      // <= gpu::kMostHistoryFrames: that a mean may stand for
    };
    void record(Recorder& rec, const Input& in);

    /// Share of the pixels that saw a surface before which the last record() remembered; waits for the device.
    double rememberedShare(const Device& device, uint32_t point_count) const;

private:
    Kernel blend_;
    std::array<Buffer, 2> pixels_; // gpu::PixelHistory[max_pixels]
    uint32_t now_ = 0;
};
