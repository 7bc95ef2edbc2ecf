#include "runtime/stages/history.h"

#include "runtime/camera.h"
#include "runtime/stages/rays.h"

#include <cmath>

HistoryStage::HistoryStage(const Device& device, uint32_t max_pixels, const Scratch& scratch)
    : compare_(device.kernel("history/compare")), blend_(device.kernel("history/blend")),
      blend_changed_(device.kernel("history/blend", {{"kLightChanged", 1}})),
      compared_(device.texelArray<gpu::PixelPairs>("history.compared", max_pixels, scratch)),
      pixels_{device.texelArray<gpu::PixelHistory>("history.pixels_a", max_pixels),
              device.texelArray<gpu::PixelHistory>("history.pixels_b", max_pixels)}
{
}

void HistoryStage::record(Recorder& rec, const Input& in)
{
    const auto scope = rec.scope("history");
    now_ = 1 - now_;
    const gpu::CameraParams& camera = in.frame.camera;
    const LightRange range = in.frame.light_range.value_or(LightRange{});
    const gpu::HistoryParams params{.point_count = camera.width * camera.height,
                                    .width = camera.width,
                                    .most_frames = in.most_frames,
                                    .has_previous = in.frame.previous.has_value(),
                                    .seed = traceSeed(camera.seed, in.frame.number, 0),
                                    .pixel_angle = camera.orthographic ? 0 : pixelSide(camera),
                                    .pixel_side = camera.orthographic ? pixelSide(camera) : 0,
                                    .moves = in.signals.moves,
                                    .least = range.least,
                                    .most = range.most};
    const bool changed = in.frame.light_range.has_value();
    if (changed)
        rec.run(compare_, params.point_count, params,
                {{"Motions", in.signals.motions},
                 {"Guides", in.signals.guides},
                 {"OldGuides", in.signals.last_guides},
                 {"OldHistory", pixels_[1 - now_]},
                 {"DirectSignals", in.signals.direct},
                 {"GlossySignals", in.signals.glossy},
                 {"DiffusePoints", in.surface.diffuse_points},
                 {"Indirect", in.light.indirect},
                 {"Caustics", in.light.caustics},
                 {"Compared", compared_},
                 {"Displacements", in.signals.displacements}});
    rec.run(changed ? blend_changed_ : blend_, params.point_count, params,
            {{"Motions", in.signals.motions},
             {"Guides", in.signals.guides},
             {"OldGuides", in.signals.last_guides},
             {"OldHistory", pixels_[1 - now_]},
             {"NewHistory", pixels_[now_]},
             {"DirectSignals", in.signals.direct},
             {"GlossySignals", in.signals.glossy},
             {"DiffusePoints", in.surface.diffuse_points},
             {"Indirect", in.light.indirect},
             {"Caustics", in.light.caustics},
             {"Compared", compared_},
             {"Displacements", in.signals.displacements}});
}

double HistoryStage::rememberedShare(const Device& device, uint32_t point_count) const
{
    const auto frames = [](gpu::HistoryLight light) { return light.words.y >> 18 & gpu::kMostHistoryFrames; };
    uint32_t remembered = 0;
    for (const gpu::PixelHistory& pixel : device.download<gpu::PixelHistory>(pixels_[now_], point_count))
        remembered += frames(pixel.indirect) > 1;
    return double(remembered) / point_count;
}
