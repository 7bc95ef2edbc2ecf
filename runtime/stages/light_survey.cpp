#include "runtime/stages/light_survey.h"

namespace
{
uint32_t tilesAlong(uint32_t pixels)
{
    return (pixels + gpu::kSurveySide - 1) / gpu::kSurveySide;
}

uint32_t tileCount(uint32_t width, uint32_t height, uint32_t path_count)
{
    return tilesAlong(width) * tilesAlong(height) * path_count;
}
} // namespace

LightSurvey::LightSurvey(const Device& device, const SceneGpu& scene, uint32_t most_clusters, uint32_t width,
                         uint32_t height, uint32_t path_count, const Scratch& scratch)
    : device_(device), scene_(scene), width_(width), height_(height), tile_count_(tileCount(width, height, path_count)),
      survey_(device.kernel("direct/survey", scene.constants())), tally_(device.kernel("direct/tally")),
      divide_(device.kernel("direct/divide")),
      arrived_(device.array<gpu::vec2>("direct.survey_arrived",
                                       uint64_t(tile_count_) * most_clusters * gpu::kSurveyRays, scratch)),
      sums_(device.array<gpu::vec2>("direct.survey_sums", uint64_t(tile_count_) * most_clusters, scratch)),
      tiles_(device.array<gpu::TileLights>("direct.tiles", tile_count_, scratch))
{
}

uint64_t LightSurvey::scratchBytes(uint32_t most_clusters, uint32_t width, uint32_t height, uint32_t path_count)
{
    return uint64_t(tileCount(width, height, path_count)) *
           ((most_clusters * gpu::kSurveyRays + most_clusters) * sizeof(gpu::vec2) + sizeof(gpu::TileLights));
}

const Buffer& LightSurvey::record(Recorder& rec, const Input& in) const
{
    const Kernel& survey =
        in.counts_rays ? device_.kernel("direct/survey", scene_.constants(), {{"kCountsRays", 1}}) : survey_;
    rec.run(survey, tile_count_ * in.cluster_count * gpu::kSurveyRays,
            gpu::SurveyParams{.point_count = in.point_count,
                              .pixel_count = width_ * height_,
                              .width = width_,
                              .tile_count = tile_count_,
                              .first_cluster = in.first_cluster,
                              .cluster_count = in.cluster_count,
                              .first_sample = in.first_sample,
                              .seed = in.seed},
            {{"Points", in.points},
             {"Clusters", in.clusters},
             {"Picks", in.picks},
             {"Arrived", arrived_},
             {"ShadowCount", in.shadow_count}});
    const gpu::TallyParams tally{.tile_count = tile_count_,
                                 .cluster_count = in.cluster_count,
                                 .columns = tilesAlong(width_),
                                 .rows = tilesAlong(height_),
                                 .extended = in.extended};
    rec.run(tally_, tile_count_ * in.cluster_count, tally, {{"Arrived", arrived_}, {"Sums", sums_}});
    rec.run(divide_, tile_count_, tally, {{"Sums", sums_}, {"Tiles", tiles_}});
    return tiles_;
}
