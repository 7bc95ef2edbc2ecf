#include "runtime/stages/antialias.h"

#include <algorithm>

namespace
{
/// In a static view, the weight in frames of the moving picture before it, and the number of frames after which it has faded out.
/// A larger weight hides the noise of the first frames longer; a shorter fade removes errors of the moving picture sooner.
constexpr uint32_t kBeforeCounts = 8, kBeforeLasts = 64;
constexpr float kMostCounted = 255;
} // namespace

AntialiasStage::AntialiasStage(const Device& device, uint32_t max_pixels)
    : blend_(device.kernel("antialias/blend")), stand_(device.kernel("antialias/stand")),
      no_direct_(device.array<gpu::vec3>("antialias.no_direct", 1)),
      no_factors_(device.array<float>("antialias.no_factors", 1)), shown_{device.array<gpu::vec3>("antialias.shown_a",
                                                                                                  max_pixels),
                                                                          device.array<gpu::vec3>("antialias.shown_b",
                                                                                                  max_pixels)},
      counts_{device.array<float>("antialias.counts_a", max_pixels),
              device.array<float>("antialias.counts_b", max_pixels)}
{
}

void AntialiasStage::recordMoving(Recorder& rec, const Buffer& picture, const Buffer& motions, uint32_t width,
                                  uint32_t height, uint32_t most_frames, bool continues, gpu::vec3 factor,
                                  const std::optional<Highlights>& highlights)
{
    const auto scope = rec.scope("antialias");
    moved_frames_ = continues ? moved_frames_ + 1 : 0;
    moving_ = 1 - latest_;
    moving_counts_ = 1 - moving_counts_;
    rec.run(blend_, width * height,
            gpu::AntialiasParams{.point_count = width * height,
                                 .width = width,
                                 .most_frames = most_frames,
                                 .highlights = highlights.has_value(),
                                 .factor = factor},
            {{"Picture", picture},
             {"Motions", motions},
             {"OldShown", shown_[latest_]},
             {"OldCounts", counts_[1 - moving_counts_]},
             {"Shown", shown_[moving_]},
             {"Counts", counts_[moving_counts_]},
             {"Direct", highlights ? highlights->direct : no_direct_},
             {"Factors", highlights ? highlights->factors : no_factors_}});
    latest_ = moving_;
}

void AntialiasStage::recordStanding(Recorder& rec, const Buffer& sum, uint32_t frames, uint32_t point_count)
{
    const auto scope = rec.scope("antialias");
    const float after = float(frames - 1), counts = float(std::min(moved_frames_, kBeforeCounts));
    latest_ = 1 - moving_;
    rec.run(
        stand_, point_count,
        gpu::StandParams{.point_count = point_count,
                         .scale = 1 / float(frames),
                         .before = counts / (counts + after) * std::max(0.0f, 1 - after / kBeforeLasts),
                         .most_frames = kMostCounted},
        {{"Sum", sum}, {"Before", shown_[moving_]}, {"Shown", shown_[latest_]}, {"Counts", counts_[moving_counts_]}});
}
