// The path tracer with one sample a pixel, remembered and filtered as the light of mode gi is: what one would build without
// photons and irradiance samples.
#pragma once
#include "runtime/light_filter.h"
#include "runtime/stages/compose.h"
#include "runtime/stages/primary.h"
#include "runtime/stages/reference.h"

class FilteredPaths
{
public:
    FilteredPaths(const Device& device, const SceneGpu& scene, const Settings& settings, uint32_t width,
                  uint32_t height);

    /// Records one frame. @return vec3[width * height], of settings.term alone where that is not all
    const Buffer& record(Recorder& rec, const RayStage& rays, const FrameInfo& frame, const Settings& settings);
    /// gpu::Motion[width * height] of the last frame that is antialiased.
    const Buffer& motions() const { return filter_.motions(); }
    std::optional<double> rememberedShare(const Device& device) const { return filter_.rememberedShare(device); }

private:
    uint32_t width_, height_;
    bool has_specular_;
    LightBuffers light_; // all that paths find after their first surface is in `direct`: one signal, one history
    PrimaryStage primary_;
    ReferenceStage paths_;
    LightFilter filter_;
    ComposeStage compose_;
};
