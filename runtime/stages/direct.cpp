#include "runtime/stages/direct.h"

#include "runtime/light_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace
{
constexpr uint32_t kGroupSeed = 0x9e3779b9; // times the kind: groups are sampled independently of each other
constexpr uint32_t kSurveySeed = 0x85ebca6b;

/// Of several lights of a kind one is chosen; those that are dark now may shine later.
bool hasChoice(std::span<const gpu::Light> lights)
{
    std::array<uint32_t, 3> counts{};
    for (const gpu::Light& light : lights)
        ++counts[size_t(lightKind(light))];
    return std::ranges::any_of(counts, [](uint32_t count) { return count > 1; });
}

/// Of local lights, dark ones included.
uint32_t countOf(std::span<const uint32_t> clusters)
{
    return clusters.empty() ? 0 : std::ranges::max(clusters) + 1;
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
    : device_(device), scene_(scene), clusters_of_(clusterLights(scene.lights())), width_(width), height_(height),
      emitters_(emitterBox(scene)), sample_(device.kernel("direct/sample", scene.constants())),
      emitted_(device.kernel("direct/emitted", scene.constants())),
      shadow_count_(device.array<gpu::QueueSize>("direct.shadow_count", 1)),
      emitter_queue_(device, "direct.emitter_queue", width * height * path_count, scratch),
      emitter_rays_(device.array<gpu::EmitterRay>("direct.emitter_rays", width * height * path_count, scratch)),
      hits_(device.texelArray<gpu::Hit>("direct.hits", width * height * path_count, scratch)),
      clusters_(device.texelArray<gpu::LightCluster>("direct.clusters", countOf(clusters_of_) + 2)),
      picks_(device.texelArray<gpu::LightPick>("direct.picks", std::max<size_t>(scene.lights().size(), 1))),
      densities_(device.array<float>("direct.densities", std::max<size_t>(scene.lights().size(), 1))),
      no_tiles_(device.array<gpu::TileLights>("direct.no_tiles", 1)), has_area_lights_(scene.hasAreaLights()),
      is_noisy_(has_area_lights_ || hasChoice(scene.lights()))
{
    const uint32_t clusters = countOf(clusters_of_);
    if (clusters > 0 && scene.hasFeature(gpu::kFeatureSpecular))
    {
        highlights_ = device.kernel("direct/highlights", scene.constants());
        factors_ = device.array<float>("direct.factors", width * height);
    }
    if (clusters > 1)
    {
        sample_seen_ = device.kernel("direct/sample", scene.constants(), {{"kKnowsSeen", 1}});
        survey_.emplace(device, scene, clusters, width, height, path_count, scratch);
    }
}

uint64_t DirectStage::scratchBytes(const SceneGpu& scene, uint32_t width, uint32_t height, uint32_t path_count)
{
    const uint64_t a_point = sizeof(gpu::Ray) + sizeof(gpu::EmitterRay) + sizeof(gpu::Hit);
    const uint32_t clusters = countOf(clusterLights(scene.lights()));
    return uint64_t(width) * height * path_count * a_point +
           (clusters > 1 ? LightSurvey::scratchBytes(clusters, width, height, path_count) : 0);
}

void DirectStage::followLights(Recorder& rec)
{
    if (table_version_ == scene_.lightTableVersion())
        return;
    table_version_ = scene_.lightTableVersion();
    lights_ = groupLights(scene_.lights(), clusters_of_);
    if (lights_.picks.empty())
        return;
    rec.write(picks_, 0, std::as_bytes(std::span(lights_.picks)));
    rec.write(clusters_, 0, std::as_bytes(std::span(lights_.clusters)));
    rec.write(densities_, 0, std::as_bytes(std::span(lights_.densities)));
}

void DirectStage::record(Recorder& rec, const RayStage& rays, const Input& in)
{
    const auto scope = rec.scope("direct");
    followLights(rec);
    if (rays.counts())
        rec.clear(shadow_count_);
    const Buffer* tiles = &no_tiles_;
    if (const auto lamps = std::ranges::find(lights_.groups, LightKind::kLocal, &LightGroup::kind);
        lamps != lights_.groups.end() && lamps->cluster_count > 1)
        tiles = &survey_->record(rec, {.points = in.points,
                                       .point_count = in.point_count,
                                       .clusters = clusters_,
                                       .picks = picks_,
                                       .first_cluster = lamps->first_cluster,
                                       .cluster_count = lamps->cluster_count,
                                       .extended = lamps->extended,
                                       .first_sample = in.first_sample,
                                       .seed = in.seed + kSurveySeed,
                                       .shadow_count = shadow_count_,
                                       .counts_rays = rays.counts()});
    tiles_ = tiles;
    for (uint32_t i = 0; i < in.light_sample_count; ++i)
        recordSample(rec, rays, in, i, *tiles);
    rays.count(rec, shadow_count_, true);
}

const Buffer* DirectStage::recordHighlights(Recorder& rec, const Buffer& points,
                                            const gpu::CameraParams& last_camera) const
{
    const auto lamps = std::ranges::find(lights_.groups, LightKind::kLocal, &LightGroup::kind);
    const bool alone = std::ranges::all_of(lights_.groups, [](const LightGroup& group)
                                           { return group.one_place || group.kind == LightKind::kLocal; });
    if (!highlights_ || lamps == lights_.groups.end() || lamps->one_place || !alone || last_camera.orthographic != 0)
        return nullptr;
    const auto scope = rec.scope("highlights");
    rec.run(*highlights_, width_ * height_,
            gpu::HighlightParams{.last_eye = last_camera.position,
                                 .pixel_count = width_ * height_,
                                 .width = width_,
                                 .first_cluster = lamps->first_cluster,
                                 .cluster_count = lamps->cluster_count},
            {{"Points", points}, {"Clusters", clusters_}, {"Tiles", *tiles_}, {"Factors", factors_}});
    return &factors_;
}

Kernel DirectStage::sampleKernel(bool knows_seen, bool counts_rays) const
{
    if (counts_rays)
        return device_.kernel("direct/sample", scene_.constants(), {{"kKnowsSeen", knows_seen}, {"kCountsRays", 1}});
    return knows_seen ? sample_seen_ : sample_;
}

void DirectStage::recordSample(Recorder& rec, const RayStage& rays, const Input& in, uint32_t light_sample,
                               const Buffer& tiles) const
{
    const gpu::EmittedParams emitted{
        .seed = traceSeed(in.seed, in.first_sample * in.light_sample_count + light_sample, ~0u)};
    rays.reset(rec, emitter_queue_.size);
    for (const LightGroup& group : lights_.groups)
    {
        const bool last = &group == &lights_.groups.back();
        const gpu::DirectParams params{.point_count = in.point_count,
                                       .first_sample = in.first_sample,
                                       .seed = in.seed,
                                       .light_sample = light_sample,
                                       .light_sample_count = in.light_sample_count,
                                       .light_seed = in.seed + uint32_t(group.kind) * kGroupSeed,
                                       .first_cluster = group.first_cluster,
                                       .cluster_count = group.cluster_count,
                                       .candidate_count = in.candidate_count,
                                       .repeats = !group.punctual,
                                       .traces_bsdf_samples = last && has_area_lights_,
                                       .pixel_count = width_ * height_,
                                       .width = width_,
                                       .emitters_low = emitters_.low,
                                       .emitters_high = emitters_.high};
        rec.run(sampleKernel(group.cluster_count > 1, rays.counts()), in.point_count, params,
                {{"Points", in.points},
                 {"Radiance", group.one_place ? in.radiance : in.noisy},
                 {"EmitterQueue", emitter_queue_.size},
                 {"Rays", emitter_queue_.rays},
                 {"EmitterRays", emitter_rays_},
                 {"Picks", picks_},
                 {"Clusters", clusters_},
                 {"Tiles", tiles},
                 {"ShadowCount", shadow_count_}});
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
