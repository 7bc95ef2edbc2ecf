// Temporal histories: while the camera moves, light is the mean of this frame's and of the same surface's in frames before.
#pragma once
#include "runtime/stages/signals.h"
#include "shaders/history/history.h"

class HistoryStage
{
public:
    /// Bytes of scratch memory, beside what aligning its buffers may cost.
    static uint64_t scratchBytes(uint32_t width, uint32_t height);
    /// @param constants of the scene, for its features; none: all terms of light are remembered
    HistoryStage(const Device& device, const SharedConstants& constants, uint32_t width, uint32_t height,
                 const Scratch& scratch = {});

    struct Input
    {
        const SignalBuffers& signals; // their light becomes the mean
        const SurfaceBuffers& surface;
        const LightBuffers& light; // so do its indirect light and caustics
        const FrameInfo& frame;    // frame.previous: record() was called for it, too
        uint32_t most_frames;      // <= gpu::kMostHistoryFrames: in a mean
        const Buffer* highlights =
            nullptr; // float[pixels]: what direct light has changed by as the eye moved; null: nothing
    };
    void record(Recorder& rec, const Input& in);

    /// Fraction of the pixels whose surface the last record() found in the history; waits for the device.
    double rememberedShare(const Device& device, uint32_t point_count) const;

private:
    uint32_t tile_count_;
    Kernel compare_, judge_, reconcile_, blend_;
    Buffer compared_; // gpu::PixelPairs[pixels]
    Buffer tiles_;    // gpu::TilePairs[tile_count_]
    Buffer blocks_;   // gpu::HistoryBlock[tile_count_ * kTileBlocks]
    Buffer followed_; // gpu::FollowedTerm[tile_count_ * kTileBlocks * kHistoryTerms]
    Buffer no_factors_;
    std::array<Buffer, 2> pixels_; // gpu::PixelHistory[pixels]
    uint32_t now_ = 0;
};
