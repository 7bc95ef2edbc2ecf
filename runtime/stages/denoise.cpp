#include "runtime/stages/denoise.h"

DenoiseStage::DenoiseStage(const Device& device, uint32_t max_pixels, const Scratch& scratch)
    : filter_(device.kernel("denoise/filter")), filtered_{device.texelArray<gpu::LightSignal>("denoise.filtered_a",
                                                                                              max_pixels, scratch),
                                                          device.texelArray<gpu::LightSignal>("denoise.filtered_b",
                                                                                              max_pixels, scratch)}
{
}

const Buffer& DenoiseStage::record(Recorder& rec, const Input& in) const
{
    const auto scope = rec.scope("denoise");
    gpu::DenoiseParams params{
        .point_count = in.width * in.height, .width = in.width, .step_ = 1, .pixel_angle = in.pixel_angle};
    const Buffer* signal = &in.signal;
    for (uint32_t pass = 0; pass < in.passes; ++pass, params.step_ *= 3)
    {
        const Buffer& filtered = filtered_[pass % 2];
        rec.run(filter_, params.point_count, params,
                {{"Guides", in.guides}, {"Signals", *signal}, {"Filtered", filtered}});
        signal = &filtered;
    }
    return *signal;
}
