#include "runtime/stages/signals.h"

#include "runtime/camera.h"
#include "runtime/stages/primary.h"

SignalsStage::SignalsStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels, const Scratch& scratch)
    : scene_(scene), prepare_(device.kernel("signals/prepare", scene.constants())),
      apply_(device.kernel("signals/apply")), views_(device.array<gpu::FrameViews>("signals.views", 1)),
      motions_(device.array<gpu::Motion>("signals.motions", max_pixels, scratch)),
      direct_(device.texelArray<gpu::LightSignal>("signals.direct", max_pixels, scratch)),
      glossy_(device.texelArray<gpu::LightSignal>("signals.glossy", max_pixels, scratch)),
      displacements_(device.array<gpu::vec3>("signals.displacements", scene.canMove() ? max_pixels : 1)),
      guides_{device.texelArray<gpu::SurfaceGuide>("signals.guides_a", max_pixels),
              device.texelArray<gpu::SurfaceGuide>("signals.guides_b", max_pixels)}
{
}

SignalBuffers SignalsStage::record(Recorder& rec, const FrameInfo& frame, const SurfaceBuffers& surface,
                                   const LightBuffers& light, uint32_t terms)
{
    const auto scope = rec.scope("signals");
    now_ = 1 - now_;
    const gpu::FrameViews views{.now = frame.camera, .last = frame.previous.value_or(frame.camera)};
    rec.write(views_, 0, std::as_bytes(std::span(&views, 1)));
    const gpu::SignalParams params{.point_count = frame.camera.width * frame.camera.height,
                                   .spread = frame.camera.orthographic ? 0 : PrimaryStage::textureWidth(frame.camera),
                                   .has_previous = frame.previous.has_value(),
                                   .terms = terms};
    rec.run(prepare_, params.point_count, params,
            {{"Views", views_},
             {"Points", surface.points},
             {"Direct", light.direct},
             {"Glossy", light.glossy},
             {"Guides", guides_[now_]},
             {"Motions", motions_},
             {"DirectSignals", direct_},
             {"GlossySignals", glossy_},
             {"LastCorners", scene_.lastCorners()},
             {"Displacements", displacements_}});
    return {.guides = guides_[now_],
            .last_guides = guides_[1 - now_],
            .motions = motions_,
            .displacements = displacements_,
            .moves = scene_.canMove(),
            .direct = direct_,
            .glossy = glossy_};
}

void SignalsStage::apply(Recorder& rec, const Buffer& own, const Buffer& filtered, const Buffer& light,
                         uint32_t point_count) const
{
    rec.run(apply_, point_count, gpu::SignalParams{.point_count = point_count},
            {{"Signals", own}, {"Filtered", filtered}, {"Radiance", light}});
}
