#include "runtime/stages/photons.h"

namespace
{
// Of caustic photons; the others keep the map unbiased for the specular surfaces that the compiler does not aim at.
constexpr float kAimedFraction = 0.9f;
} // namespace

PhotonStage::PhotonStage(const Device& device, const SceneGpu& scene, PhotonKind kind, uint32_t max_paths, uint32_t max_bounces)
    : kind_(kind), has_specular_(scene.hasFeature(gpu::kFeatureSpecular)), has_targets_(scene.info().caustic_target_count > 0),
      emit_(device.kernel("photons/emit", scene.constants())), scatter_(device.kernel("photons/scatter", scene.constants())),
      queue_(device, "photons.queue", max_paths), next_queue_(device, "photons.next_queue", max_paths),
      hits_(device.texelArray<gpu::Hit>("photons.hits", max_paths)),
      states_(device.array<gpu::PhotonState>("photons.states", max_paths)),
      photons_(device.array<gpu::Photon>("photons.photons", uint64_t(max_paths) * max_bounces)),
      flags_(device.array<uint32_t>("photons.flags", uint64_t(max_paths) * max_bounces))
{
}

PhotonStage::Output PhotonStage::record(Recorder& rec, const RayStage& rays, const Input& in) const
{
    const bool caustic = kind_ == PhotonKind::kCaustic;
    rec.clear(flags_);
    rays.reset(rec, queue_.size);
    const gpu::EmitParams emission{.path_count = in.path_count,
                                   .first_path = in.first_path,
                                   .seed = in.seed,
                                   .aim = caustic && has_targets_ ? kAimedFraction : 0.0f};
    rec.run(emit_, in.path_count, emission, {{"Queue", queue_.size}, {"Rays", queue_.rays}, {"States", states_}});
    rays.close(rec, queue_.size);

    const RayQueue* queue = &queue_;
    const RayQueue* next = &next_queue_;
    const uint32_t events = in.bounce_limit + (has_specular_ ? in.specular_depth : 0);
    for (uint32_t event = 0; event < events; ++event)
    {
        const gpu::ScatterParams params{.path_count = in.path_count,
                                        .first_path = in.first_path,
                                        .seed = in.seed,
                                        .event = event,
                                        .bounce_limit = in.bounce_limit,
                                        .caustic = caustic};
        rays.closest(rec, *queue, hits_, traceSeed(in.seed, in.first_path, event));
        rays.reset(rec, next->size);
        rec.runIndirect(scatter_, queue->size, 0, params,
                        {{"Queue", queue->size}, {"Rays", queue->rays}, {"Hits", hits_}, {"States", states_}, {"Photons", photons_},
                         {"Flags", flags_}, {"NextQueue", next->size}, {"NextRays", next->rays}});
        rays.close(rec, next->size);
        std::swap(queue, next);
    }
    return {.photons = photons_, .flags = flags_, .slot_count = in.path_count * in.bounce_limit};
}
