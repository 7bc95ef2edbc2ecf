#include "runtime/stages/direct.h"

#include <algorithm>
#include <cmath>

namespace
{
constexpr uint32_t kGroupSeed = 0x9e3779b9; // times the kind: groups are sampled independently of each other
constexpr uint32_t kSurveySeed = 0x85ebca6b;

/// Of local lights.
uint32_t localClusters(const SceneGpu& scene)
{
    std::vector<uint32_t> clusters;
    for (const LightProbability& light : scene.lightProbabilities())
        if (!light.isInfinite() && light.pmf > 0)
            clusters.push_back(light.cluster);
    std::ranges::sort(clusters);
    return uint32_t(std::ranges::unique(clusters).begin() - clusters.begin());
}
} // namespace

EmitterBox emitterBox(const SceneGpu& scene)
{
    constexpr float kEverywhere = 1e18f; // metres; differences and their products with 1 / a direction stay finite
    EmitterBox box{.low = {-kEverywhere, -kEverywhere, -kEverywhere}, .high = {kEverywhere, kEverywhere, kEverywhere}};
    if (scene.hasFeature(gpu::kFeatureEnvironment) || scene.canMove())
        return box;
    std::swap(box.low, box.high); // empty
    for (const gpu::Light& light : scene.emitters().lights)
        if (light.kind == gpu::kLightTriangle || light.kind == gpu::kLightTriangleTwoSided)
            for (const gpu::vec3& p : {light.p0, light.p1, light.p2})
            {
                box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
                box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
            }
    // Wider by what rounding may do to a ray that grazes it.
    const auto magnitude = [](float a, float b) { return std::max(std::abs(a), std::abs(b)); };
    const float slack = 1e-4f * std::max({magnitude(box.low.x, box.high.x), magnitude(box.low.y, box.high.y),
                                          magnitude(box.low.z, box.high.z)});
    box.low = {box.low.x - slack, box.low.y - slack, box.low.z - slack};
    box.high = {box.high.x + slack, box.high.y + slack, box.high.z + slack};
    return box;
}

DirectStage::DirectStage(const Device& device, const SceneGpu& scene, uint32_t width, uint32_t height,
                         uint32_t path_count, const Scratch& scratch)
    : lights_(groupLights(scene.lightProbabilities())), width_(width), height_(height), emitters_(emitterBox(scene)),
      sample_(device.kernel("direct/sample", scene.constants())),
      emitted_(device.kernel("direct/emitted", scene.constants())),
      emitter_queue_(device, "direct.emitter_queue", width * height * path_count, scratch),
      shadow_size_(device.array<gpu::QueueSize>("direct.shadow_size", 1)),
      shadow_rays_(device.texelArray<gpu::ShadowRay>("direct.shadow_rays", width * height * path_count, scratch)),
      emitter_rays_(device.array<gpu::EmitterRay>("direct.emitter_rays", width * height * path_count, scratch)),
      hits_(device.texelArray<gpu::Hit>("direct.hits", width * height * path_count, scratch)),
      clusters_(device.upload<gpu::LightCluster>("direct.clusters", lights_.clusters)),
      picks_(device.upload<gpu::LightPick>("direct.picks", lights_.picks)),
      densities_(device.upload<float>("direct.densities", lights_.densities)),
      rest_size_(device.array<gpu::QueueSize>("direct.rest_size", 1)), has_area_lights_(scene.hasAreaLights()),
      is_noisy_(has_area_lights_ || !std::ranges::all_of(lights_.groups, &LightGroup::one_place))
{
    const uint32_t clusters = localClusters(scene);
    if (clusters > 1)
        survey_.emplace(device, scene, clusters, width, height, path_count, scratch);
    rest_rays_ =
        device.texelArray<gpu::ShadowRay>("direct.rest_rays", survey_ ? width * height * path_count : 1, scratch);
    no_tiles_ = device.array<gpu::TileLights>("direct.no_tiles", 1);
}

uint64_t DirectStage::scratchBytes(const SceneGpu& scene, uint32_t width, uint32_t height, uint32_t path_count)
{
    const uint32_t clusters = localClusters(scene);
    const uint64_t a_point =
        sizeof(gpu::Ray) + (clusters > 1 ? 2 : 1) * sizeof(gpu::ShadowRay) + sizeof(gpu::EmitterRay) + sizeof(gpu::Hit);
    return uint64_t(width) * height * path_count * a_point +
           (clusters > 1 ? LightSurvey::scratchBytes(clusters, width, height, path_count) : 0);
}

void DirectStage::record(Recorder& rec, const RayStage& rays, const Input& in) const
{
    const auto scope = rec.scope("direct");
    const Buffer* tiles = &no_tiles_;
    if (survey_)
        tiles = &survey_->record(rec, rays,
                                 {.points = in.points,
                                  .point_count = in.point_count,
                                  .clusters = clusters_,
                                  .picks = picks_,
                                  .first_cluster = lights_.groups.back().first_cluster,
                                  .first_sample = in.first_sample,
                                  .seed = in.seed + kSurveySeed});
    for (uint32_t i = 0; i < in.light_sample_count; ++i)
        recordSample(rec, rays, in, i, *tiles);
}

void DirectStage::recordSample(Recorder& rec, const RayStage& rays, const Input& in, uint32_t light_sample,
                               const Buffer& tiles) const
{
    const gpu::EmittedParams emitted{
        .seed = traceSeed(in.seed, in.first_sample * in.light_sample_count + light_sample, ~0u)};
    rays.reset(rec, emitter_queue_.size);
    for (const LightGroup& group : lights_.groups)
    {
        const bool last = &group == &lights_.groups.back(), several = group.cluster_count > 1;
        const gpu::DirectParams params{.point_count = in.point_count,
                                       .first_sample = in.first_sample,
                                       .seed = in.seed,
                                       .light_sample = light_sample,
                                       .light_sample_count = in.light_sample_count,
                                       .light_seed = in.seed + uint32_t(group.kind) * kGroupSeed,
                                       .first_cluster = group.first_cluster,
                                       .knows_seen = several,
                                       .cluster_count = group.cluster_count,
                                       .candidate_count = group.one_place ? 1 : in.candidate_count,
                                       .traces_bsdf_samples = last && has_area_lights_,
                                       .pixel_count = width_ * height_,
                                       .width = width_,
                                       .emitters_low = emitters_.low,
                                       .emitters_high = emitters_.high};
        rays.reset(rec, shadow_size_);
        rays.reset(rec, rest_size_);
        rec.run(sample_, in.point_count, params,
                {{"Points", in.points},
                 {"ShadowQueue", shadow_size_},
                 {"ShadowRays", shadow_rays_},
                 {"EmitterQueue", emitter_queue_.size},
                 {"Rays", emitter_queue_.rays},
                 {"EmitterRays", emitter_rays_},
                 {"Picks", picks_},
                 {"Clusters", clusters_},
                 {"Tiles", tiles},
                 {"RestQueue", rest_size_},
                 {"RestRays", rest_rays_}});
        rays.close(rec, shadow_size_);
        rays.visible(rec, shadow_size_, shadow_rays_, group.one_place ? in.radiance : in.noisy);
        if (!several)
            continue;
        rays.close(rec, rest_size_);
        rays.visible(rec, rest_size_, rest_rays_, in.noisy);
    }
    if (!has_area_lights_)
        return;
    rays.close(rec, emitter_queue_.size);
    rays.closest(rec, emitter_queue_, hits_, emitted.seed);
    rec.runIndirect(emitted_, emitter_queue_.size, emitted,
                    {{"EmitterQueue", emitter_queue_.size},
                     {"Rays", emitter_queue_.rays},
                     {"Hits", hits_},
                     {"EmitterRays", emitter_rays_},
                     {"Radiance", in.noisy},
                     {"Densities", densities_}});
}
