#include "runtime/stages/history.h"

#include "runtime/camera.h"
#include "runtime/stages/rays.h"

#include <cmath>

namespace
{
uint32_t tileCount(uint32_t width, uint32_t height)
{
    constexpr uint32_t kSide = gpu::kHistoryTileSide;
    static_assert(kSide * kSide == gpu::kHistoryTileSize);
    return ((width + kSide - 1) / kSide) * ((height + kSide - 1) / kSide);
}
} // namespace

HistoryStage::HistoryStage(const Device& device, const SharedConstants& constants, uint32_t width, uint32_t height,
                           const Scratch& scratch)
    : tile_count_(tileCount(width, height)), compare_(device.kernel("history/compare", constants)),
      judge_(device.kernel("history/judge", constants)), reconcile_(device.kernel("history/reconcile", constants)),
      blend_(device.kernel("history/blend", constants)),
      compared_(device.texelArray<gpu::PixelPairs>("history.compared", width * height, scratch)),
      tiles_(device.array<gpu::TilePairs>("history.tiles", tile_count_, scratch)),
      blocks_(device.array<gpu::HistoryBlock>("history.blocks", tile_count_ * gpu::kTileBlocks, scratch)),
      followed_(device.texelArray<gpu::FollowedTerm>("history.followed",
                                                     tile_count_ * gpu::kTileBlocks * gpu::kHistoryTerms, scratch)),
      no_factors_(device.array<float>("history.no_factors", 1)), pixels_{device.texelArray<gpu::PixelHistory>(
                                                                             "history.pixels_a", width * height),
                                                                         device.texelArray<gpu::PixelHistory>(
                                                                             "history.pixels_b", width * height)}
{
}

uint64_t HistoryStage::scratchBytes(uint32_t width, uint32_t height)
{
    constexpr uint64_t kTileBytes =
        sizeof(gpu::TilePairs) +
        gpu::kTileBlocks * (sizeof(gpu::HistoryBlock) + gpu::kHistoryTerms * sizeof(gpu::FollowedTerm));
    return uint64_t(width) * height * sizeof(gpu::PixelPairs) + tileCount(width, height) * kTileBytes;
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
                                    .highlights = in.highlights != nullptr,
                                    .least = range.least,
                                    .most = range.most};
    const Buffer& factors = in.highlights != nullptr ? *in.highlights : no_factors_;
    check(tileCount(camera.width, camera.height) <= tile_count_, "{} x {}", camera.width, camera.height);
    if (!in.frame.light_range)
        return rec.run(blend_, params.point_count, params,
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
                        {"Displacements", in.signals.displacements},
                        {"Factors", factors}});
    const uint32_t thread_count = tileCount(camera.width, camera.height) * gpu::kHistoryTileSize;
    rec.run(compare_, thread_count, params,
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
             {"Displacements", in.signals.displacements},
             {"Factors", factors},
             {"Tiles", tiles_},
             {"Blocks", blocks_}});
    rec.run(judge_, tileCount(camera.width, camera.height) * gpu::kTileBlocks * gpu::kHistoryTerms, params,
            {{"Motions", in.signals.motions},
             {"Guides", in.signals.guides},
             {"Compared", compared_},
             {"Tiles", tiles_},
             {"Blocks", blocks_},
             {"FollowedTerms", followed_}});
    rec.run(reconcile_, params.point_count, params,
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
             {"Displacements", in.signals.displacements},
             {"Factors", factors},
             {"Blocks", blocks_},
             {"FollowedTerms", followed_}});
}

double HistoryStage::rememberedShare(const Device& device, uint32_t point_count) const
{
    const auto frames = [](gpu::HistoryLight light) { return light.words.y >> 18 & gpu::kMostHistoryFrames; };
    uint32_t remembered = 0;
    for (const gpu::PixelHistory& pixel : device.download<gpu::PixelHistory>(pixels_[now_], point_count))
        remembered += frames(pixel.indirect) > 1;
    return double(remembered) / point_count;
}
