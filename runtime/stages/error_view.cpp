#include "runtime/stages/error_view.h"

#include <algorithm>
#include <cmath>

namespace
{
/// A hundredth of the mean: what is darker than that is black beside the rest.
float floorOf(std::span<const gpu::vec3> reference)
{
    double sum = 0;
    for (const gpu::vec3& pixel : reference)
        if (const float most = std::max({pixel.x, pixel.y, pixel.z}); std::isfinite(most))
            sum += most;
    return std::max(float(0.01 * sum / double(reference.size())), 1e-20f);
}
} // namespace

ErrorView::ErrorView(const Device& device, std::span<const gpu::vec3> reference, uint32_t width, uint32_t height,
                     uint32_t max_pixels)
    : error_(device.kernel("views/error")), reference_(device.upload<gpu::vec3>("views.reference", reference)),
      colors_(device.array<gpu::vec3>("views.errors", max_pixels)), reference_width_(width), reference_height_(height),
      floor_(floorOf(reference))
{
}

void ErrorView::record(Recorder& rec, const Buffer& sum, uint32_t sample_count, uint32_t width, uint32_t height) const
{
    const gpu::ErrorViewParams params{.width = width,
                                      .height = height,
                                      .reference_width = reference_width_,
                                      .reference_height = reference_height_,
                                      .scale = 1.0f / float(std::max(sample_count, 1u)),
                                      .floor_ = floor_};
    rec.run(error_, width * height, params, {{"Sum", sum}, {"Reference", reference_}, {"Colors", colors_}});
}
