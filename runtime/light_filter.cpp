#include "runtime/light_filter.h"

#include "runtime/camera.h"

LightFilter::LightFilter(const Device& device, const SceneGpu& scene, const Settings& settings, uint32_t width,
                         uint32_t height, bool is_noisy, const Scratch& scratch)
    : width_(width), height_(height)
{
    const bool filters = settings.denoise_passes > 0 && is_noisy;
    if (filters || settings.history_frames > 0 || settings.antialias_frames > 0)
        signals_.emplace(device, scene, width * height, scratch);
    if (settings.history_frames > 0)
        history_.emplace(device, scene.transportConstants(), width, height, scratch.part());
    if (filters)
        denoise_.emplace(device, width * height, scratch.part());
}

void LightFilter::record(Recorder& rec, const FrameInfo& frame, const SurfaceBuffers& surface,
                         const LightBuffers& light, const FramePlan& plan, const Settings& settings,
                         const Buffer* highlights)
{
    if (plan.denoise_passes == 0 && !plan.remembers && !plan.antialiases)
        return;
    const SignalBuffers signals = signals_->record(rec, frame, surface, light, plan.lightTerms());
    if (plan.remembers)
        history_->record(rec, {.signals = signals,
                               .surface = surface,
                               .light = light,
                               .frame = frame,
                               .most_frames = settings.history_frames,
                               .highlights = highlights});
    if (plan.noisy_direct)
        filter(rec, frame, signals, signals.direct, light.direct, plan);
    if (plan.glossy)
        filter(rec, frame, signals, signals.glossy, light.glossy, plan);
}

void LightFilter::filter(Recorder& rec, const FrameInfo& frame, const SignalBuffers& signals, const Buffer& signal,
                         const Buffer& light, const FramePlan& plan) const
{
    const Buffer& filtered =
        plan.denoise_passes > 0
            ? denoise_->record(rec, {.signal = signal,
                                     .guides = signals.guides,
                                     .width = width_,
                                     .height = height_,
                                     .passes = plan.denoise_passes,
                                     .pixel_angle = frame.camera.orthographic ? 0 : pixelSide(frame.camera)})
            : signal;
    if (plan.remembers || plan.denoise_passes > 0)
        signals_->apply(rec, signal, filtered, light, width_ * height_);
}

std::optional<double> LightFilter::rememberedShare(const Device& device) const
{
    return history_ ? std::optional(history_->rememberedShare(device, width_ * height_)) : std::nullopt;
}
