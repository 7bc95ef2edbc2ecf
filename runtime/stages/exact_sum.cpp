#include "runtime/stages/exact_sum.h"

ExactSumStage::ExactSumStage(const Device& device, uint32_t pixel_count)
    : add_(device.kernel("resolve/add_exactly")), pixel_count_(pixel_count),
      sums_(device.array<uint32_t>("exact_sum.sums", 3 * gpu::kExactWords * pixel_count)),
      non_finite_(device.array<uint32_t>("exact_sum.non_finite", 1))
{
}

void ExactSumStage::clear(Recorder& rec) const
{
    rec.clear(sums_);
    rec.clear(non_finite_);
}

void ExactSumStage::record(Recorder& rec, const Buffer& radiance, uint32_t first, uint32_t last) const
{
    const auto scope = rec.scope("sum");
    rec.run(add_, 3 * pixel_count_, gpu::AddExactlyParams{.pixel_count = pixel_count_, .first = first, .last = last},
            {{"Radiance", radiance}, {"Sums", sums_}, {"NonFinite", non_finite_}});
}
