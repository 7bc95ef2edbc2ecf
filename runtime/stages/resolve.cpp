#include "runtime/stages/resolve.h"

#include <algorithm>
#include <cmath>

ResolveStage::ResolveStage(const Device& device, uint32_t max_pixels)
    : accumulate_(device.kernel("resolve/accumulate")), tonemap_(device.kernel("resolve/tonemap")),
      sum_(device.array<gpu::vec3>("resolve.sum", max_pixels)),
      compensation_(device.array<gpu::vec3>("resolve.compensation", max_pixels)),
      non_finite_(device.array<uint32_t>("resolve.non_finite", 1)),
      pixels_(device.array<uint32_t>("resolve.pixels", max_pixels))
{
}

void ResolveStage::restart(Recorder& rec)
{
    rec.clear(sum_);
    rec.clear(compensation_);
    rec.clear(non_finite_);
    sample_count_ = 0;
}

void ResolveStage::accumulate(Recorder& rec, const Buffer& radiance, uint32_t pixel_count, uint32_t sample_count)
{
    const auto scope = rec.scope("accumulate");
    rec.run(accumulate_, pixel_count, gpu::AccumulateParams{.pixel_count = pixel_count, .sample_count = sample_count},
            {{"Radiance", radiance}, {"Sum", sum_}, {"Compensation", compensation_}, {"NonFinite", non_finite_}});
    sample_count_ += sample_count;
}

const Buffer& ResolveStage::display(Recorder& rec, uint32_t pixel_count, float exposure, Tonemap tonemap, bool bgra)
{
    return display(rec, sum_, 1 / float(std::max(sample_count_, 1u)), pixel_count, exposure, tonemap, bgra);
}

const Buffer& ResolveStage::display(Recorder& rec, const Buffer& picture, float scale, uint32_t pixel_count,
                                    float exposure, Tonemap tonemap, bool bgra)
{
    const auto scope = rec.scope("resolve");
    const gpu::TonemapParams params{.pixel_count = pixel_count,
                                    .scale = std::exp2(exposure) * scale,
                                    .curve = uint32_t(tonemap),
                                    .swap_red_blue = bgra};
    rec.run(tonemap_, pixel_count, params, {{"Sum", picture}, {"Pixels", pixels_}});
    return pixels_;
}
