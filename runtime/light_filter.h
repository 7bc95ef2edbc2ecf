// Noise out of a frame's light: means with the frames before, and with pixels of the same surface.
#pragma once
#include "runtime/frame/plan.h"
#include "runtime/stages/denoise.h"
#include "runtime/stages/history.h"
#include "runtime/stages/signals.h"

#include <optional>

class LightFilter
{
public:
    /// Allocates for what `settings` ask for. @param is_noisy whether the filter over pixels may be needed, @param scratch holds the
    /// signals afterwards; what is then allocated from it must not be written before record() is done
    LightFilter(const Device& device, const SceneGpu& scene, const Settings& settings, uint32_t width, uint32_t height,
                bool is_noisy, const Scratch& scratch = {});

    /// As the plan says, in place. @param highlights of HistoryStage::Input
    void record(Recorder& rec, const FrameInfo& frame, const SurfaceBuffers& surface, const LightBuffers& light,
                const FramePlan& plan, const Settings& settings, const Buffer* highlights = nullptr);
    /// gpu::Motion[width * height] of the last frame whose plan antialiases.
    const Buffer& motions() const { return signals_->motions(); }
    /// Share of the pixels that went on from a history in the last frame, none where none is kept; waits for the device.
    std::optional<double> rememberedShare(const Device& device) const;

private:
    void filter(Recorder& rec, const FrameInfo& frame, const SignalBuffers& signals, const Buffer& signal,
                const Buffer& light, const FramePlan& plan) const;

    uint32_t width_, height_;
    std::optional<SignalsStage> signals_; // where filters or histories are asked for
    std::optional<HistoryStage> history_;
    std::optional<DenoiseStage> denoise_;
};
