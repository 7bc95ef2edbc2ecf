#include "runtime/stages/light_survey.h"

namespace
{
uint32_t tileCount(uint32_t width, uint32_t height, uint32_t path_count)
{
    const auto along = [](uint32_t pixels) { return (pixels + gpu::kSurveySide - 1) / gpu::kSurveySide; };
    return along(width) * along(height) * path_count;
}
} // namespace

LightSurvey::LightSurvey(const Device& device, const SceneGpu& scene, uint32_t most_clusters, uint32_t width,
                         uint32_t height, uint32_t path_count, const Scratch& scratch)
    : width_(width), height_(height), tile_count_(tileCount(width, height, path_count)),
      survey_(device.kernel("direct/survey", scene.constants())), tally_(device.kernel("direct/tally")),
      queue_size_(device.array<gpu::QueueSize>("direct.survey_size", 1)),
      shadow_rays_(device.texelArray<gpu::ShadowRay>(
          "direct.survey_rays", uint64_t(tile_count_) * most_clusters * gpu::kSurveyRays, scratch)),
      arrived_(device.array<gpu::vec3>("direct.survey_arrived",
                                       uint64_t(tile_count_) * most_clusters * gpu::kSurveyRays, scratch)),
      tiles_(device.texelArray<gpu::TileLights>("direct.tiles", tile_count_, scratch))
{
}

uint64_t LightSurvey::scratchBytes(uint32_t most_clusters, uint32_t width, uint32_t height, uint32_t path_count)
{
    return uint64_t(tileCount(width, height, path_count)) *
           (most_clusters * gpu::kSurveyRays * (sizeof(gpu::ShadowRay) + sizeof(gpu::vec3)) + sizeof(gpu::TileLights));
}

const Buffer& LightSurvey::record(Recorder& rec, const RayStage& rays, const Input& in) const
{
    rays.reset(rec, queue_size_);
    rec.run(survey_, tile_count_ * in.cluster_count * gpu::kSurveyRays,
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
             {"ShadowQueue", queue_size_},
             {"ShadowRays", shadow_rays_},
             {"Arrived", arrived_}});
    rays.close(rec, queue_size_);
    rays.visible(rec, queue_size_, shadow_rays_, arrived_);
    rec.run(tally_, tile_count_, gpu::TallyParams{.tile_count = tile_count_, .cluster_count = in.cluster_count},
            {{"Arrived", arrived_}, {"Tiles", tiles_}});
    return tiles_;
}
