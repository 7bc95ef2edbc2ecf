#include "runtime/stages/photons.h"

namespace
{
// Of caustic photons; the others keep the map unbiased for the specular surfaces that the compiler does not aim at.
constexpr float kAimedFraction = 0.9f;
} // namespace

PhotonStage::PhotonStage(const Device& device, const SceneGpu& scene, PhotonKind kind, uint32_t max_paths,
                         uint32_t max_bounces)
    : kind_(kind), has_specular_(scene.hasFeature(gpu::kFeatureSpecular)),
      has_targets_(scene.info().caustic_target_count > 0), emit_(device.kernel("photons/emit", scene.constants())),
      trace_(device.kernel("photons/trace", scene.constants())),
      starts_(device.array<gpu::PhotonStart>("photons.starts", max_paths)),
      photons_(device.array<gpu::Photon>("photons.photons", uint64_t(max_paths) * max_bounces)),
      flags_(device.array<uint32_t>("photons.flags", uint64_t(max_paths) * max_bounces)),
      traced_(device.array<gpu::QueueSize>("photons.traced", 1))
{
}

PhotonStage::Output PhotonStage::record(Recorder& rec, const RayStage& rays, const Input& in) const
{
    const bool caustic = kind_ == PhotonKind::kCaustic;
    const gpu::EmitParams emission{.path_count = in.path_count,
                                   .first_path = in.first_path,
                                   .seed = in.seed,
                                   .aim = caustic && has_targets_ ? kAimedFraction : 0.0f};
    if (in.guide)
        in.guide->emit(rec, starts_, emission);
    else
        rec.run(emit_, in.path_count, emission, {{"Starts", starts_}});

    rec.clear(flags_);
    rec.clear(traced_);
    const gpu::TraceParams params{.path_count = in.path_count,
                                  .first_path = in.first_path,
                                  .seed = in.seed,
                                  .event_limit = in.bounce_limit + (has_specular_ ? in.specular_depth : 0),
                                  .bounce_limit = in.bounce_limit,
                                  .caustic = caustic};
    rec.run(trace_, in.path_count, params,
            {{"Starts", starts_}, {"Photons", photons_}, {"Flags", flags_}, {"Traced", traced_}});
    rays.count(rec, traced_);
    return {.photons = photons_, .flags = flags_, .slot_count = in.path_count * in.bounce_limit};
}
