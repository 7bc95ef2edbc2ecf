#include "runtime/stages/compose.h"

#include "shaders/compose/compose.h"

ComposeStage::ComposeStage(const Device& device, uint32_t max_pixels, const Scratch& scratch)
    : sum_(device.kernel("compose/sum")), picture_(device.array<gpu::vec3>("compose.picture", max_pixels, scratch))
{
}

const Buffer& ComposeStage::record(Recorder& rec, const LightBuffers& light, const FramePlan& plan,
                                   uint32_t pixel_count, uint32_t point_count) const
{
    const auto scope = rec.scope("compose");
    rec.run(sum_, pixel_count,
            gpu::ComposeParams{.pixel_count = pixel_count, .point_count = point_count, .terms = plan.lightTerms()},
            {{"Emission", light.emission},
             {"SharpDirect", light.sharp_direct},
             {"Direct", light.direct},
             {"Indirect", light.indirect},
             {"Glossy", light.glossy},
             {"Caustics", light.caustics},
             {"Picture", picture_}});
    return picture_;
}
