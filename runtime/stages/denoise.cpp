#include "runtime/stages/denoise.h"

DenoiseStage::DenoiseStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels)
    : prepare_(device.kernel("denoise/prepare", scene.constants())), filter_(device.kernel("denoise/filter")),
      apply_(device.kernel("denoise/apply")),
      guides_(device.texelArray<gpu::DenoiseGuide>("denoise.guides", max_pixels)),
      signals_(device.texelArray<gpu::DenoiseSignal>("denoise.signals", max_pixels)),
      filtered_{device.texelArray<gpu::DenoiseSignal>("denoise.filtered_a", max_pixels),
                device.texelArray<gpu::DenoiseSignal>("denoise.filtered_b", max_pixels)}
{
}

void DenoiseStage::record(Recorder& rec, const Input& in) const
{
    const auto scope = rec.scope("denoise");
    gpu::DenoiseParams params{.point_count = in.width * in.height,
                              .width = in.width,
                              .step_ = 1,
                              .pixel_angle = in.pixel_angle,
                              .glossy = in.glossy};
    rec.run(prepare_, params.point_count, params,
            {{"Points", in.points},
             {"Radiance", in.light},
             {"Guides", guides_},
             {"Signals", signals_}});
    const Buffer* signals = &signals_;
    for (uint32_t pass = 0; pass < in.passes; ++pass, params.step_ *= 3)
    {
        const Buffer& filtered = filtered_[pass % 2];
        rec.run(filter_, params.point_count, params,
                {{"Guides", guides_}, {"Signals", *signals}, {"Filtered", filtered}});
        signals = &filtered;
    }
    rec.run(apply_, params.point_count, params,
            {{"Signals", signals_}, {"Filtered", *signals}, {"Radiance", in.light}});
}
