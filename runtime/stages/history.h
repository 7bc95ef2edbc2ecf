// Temporal histories: while the camera moves, light is the mean of this frame's and of the same surface's in frames before.
#pragma once
#include "runtime/stages/signals.h"
#include "shaders/history/history.h"

class HistoryStage
{
public:
    HistoryStage(const Device& device, uint32_t max_pixels, const Scratch& scratch = {});

    struct Input
    {
        const SignalBuffers& signals; // their light becomes the mean
        const SurfaceBuffers& surface;
        const LightBuffers& light; // so do its indirect light and caustics
        const FrameInfo& frame;    // frame.previous: record() was called for it, too
        uint32_t most_frames;      // <= gpu::kMostHistoryFrames: in a mean
    };
    void record(Recorder& rec, const Input& in);

    /// Fraction of the pixels whose surface the last record() found in the history; waits for the device.
    double rememberedShare(const Device& device, uint32_t point_count) const;

private:
    Kernel compare_, blend_, blend_changed_;
    Buffer compared_;              // gpu::PixelPairs[max_pixels]
    std::array<Buffer, 2> pixels_; // gpu::PixelHistory[max_pixels]
    uint32_t now_ = 0;
};
