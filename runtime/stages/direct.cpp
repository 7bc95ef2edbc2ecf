#include "runtime/stages/direct.h"

#include <algorithm>
#include <array>

namespace
{
constexpr uint32_t kGroupSeed = 0x9e3779b9; // times the kind: groups are sampled independently of each other

/// Of several lights of a kind one is chosen; those that are dark now may shine later.
bool hasChoice(std::span<const gpu::Light> lights)
{
    std::array<uint32_t, 3> counts{};
    for (const gpu::Light& light : lights)
        ++counts[size_t(lightKind(light))];
    return std::ranges::any_of(counts, [](uint32_t count) { return count > 1; });
}
} // namespace

DirectStage::DirectStage(const Device& device, const SceneGpu& scene, uint32_t max_pixels, const Scratch& scratch)
    : scene_(scene), sample_(device.kernel("direct/sample", scene.constants())),
      emitted_(device.kernel("direct/emitted", scene.constants())),
      emitter_queue_(device, "direct.emitter_queue", max_pixels, scratch),
      shadow_size_(device.array<gpu::QueueSize>("direct.shadow_size", 1)),
      shadow_rays_(device.array<gpu::ShadowRay>("direct.shadow_rays", max_pixels, scratch)),
      emitter_rays_(device.array<gpu::EmitterRay>("direct.emitter_rays", max_pixels, scratch)),
      hits_(device.texelArray<gpu::Hit>("direct.hits", max_pixels, scratch)),
      picks_(device.array<gpu::LightPick>("direct.picks", std::max<size_t>(scene.lights().size(), 1))),
      has_area_lights_(scene.hasAreaLights()), is_noisy_(has_area_lights_ || hasChoice(scene.lights()))
{
}

void DirectStage::followLights(Recorder& rec)
{
    if (table_version_ == scene_.lightTableVersion())
        return;
    table_version_ = scene_.lightTableVersion();
    lights_ = groupLights(scene_.lights());
    rec.write(picks_, 0, std::as_bytes(std::span(lights_.picks)));
}

void DirectStage::record(Recorder& rec, const RayStage& rays, const Input& in)
{
    const auto scope = rec.scope("direct");
    followLights(rec);
    for (uint32_t i = 0; i < in.light_sample_count; ++i)
        recordSample(rec, rays, in, i);
}

void DirectStage::recordSample(Recorder& rec, const RayStage& rays, const Input& in, uint32_t light_sample) const
{
    gpu::EmittedParams emitted{.seed = traceSeed(in.seed, in.first_sample * in.light_sample_count + light_sample, ~0u)};
    rays.reset(rec, emitter_queue_.size);
    for (const LightGroup& group : lights_.groups)
    {
        const bool last = &group == &lights_.groups.back();
        const uint32_t candidates = group.one_place ? 1 : in.candidate_count;
        if (group.kind != LightKind::kDirectional)
            (group.kind == LightKind::kEnvironment ? emitted.environment_density : emitted.local_density) =
                1 / group.share;
        const gpu::DirectParams params{.point_count = in.point_count,
                                       .first_sample = in.first_sample,
                                       .seed = in.seed,
                                       .light_sample = light_sample,
                                       .light_sample_count = in.light_sample_count,
                                       .light_seed = in.seed + uint32_t(group.kind) * kGroupSeed,
                                       .first_pick = group.first_pick,
                                       .pick_count = group.pick_count,
                                       .share = group.share,
                                       .candidate_count = candidates,
                                       .traces_bsdf_samples = last && has_area_lights_};
        rays.reset(rec, shadow_size_);
        rec.run(sample_, in.point_count, params,
                {{"Points", in.points},
                 {"ShadowQueue", shadow_size_},
                 {"ShadowRays", shadow_rays_},
                 {"EmitterQueue", emitter_queue_.size},
                 {"Rays", emitter_queue_.rays},
                 {"EmitterRays", emitter_rays_},
                 {"Picks", picks_}});
        rays.close(rec, shadow_size_);
        rays.visible(rec, shadow_size_, shadow_rays_, group.one_place ? in.radiance : in.noisy);
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
                     {"Radiance", in.noisy}});
}
