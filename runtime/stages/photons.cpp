#include "runtime/stages/photons.h"

namespace
{
// Of caustic photons; the others keep the map unbiased for the specular surfaces that the compiler does not aim at.
constexpr float kAimedFraction = 0.9f;
} // namespace

PhotonStage::PhotonStage(const Device& device, const SceneGpu& scene, PhotonKind kind, uint32_t max_paths,
                         uint32_t capacity, const Scratch& scratch)
    : kind_(kind), has_targets_(scene.info().caustic_target_count > 0), capacity_(capacity),
      emit_(device.kernel("photons/emit", scene.transportConstants())),
      trace_(device.kernel("photons/trace", scene.transportConstants())), close_(device.kernel("photons/close")),
      place_(device.kernel("photons/place")), scan_(device, "photons.scan", max_paths),
      starts_(device.array<gpu::PhotonStart>("photons.starts", max_paths, scratch)),
      photons_(device.array<gpu::Photon>("photons.photons", capacity, scratch)),
      tags_(device.array<gpu::PhotonTag>("photons.tags", capacity, scratch)),
      appended_(device.array<uint32_t>("photons.appended", 1)),
      counts_(device.array<uint32_t>("photons.counts", max_paths, scratch)),
      offsets_(device.array<uint32_t>("photons.offsets", max_paths, scratch)),
      total_(device.array<uint32_t>("photons.total", 1)), store_(device.array<gpu::PhotonStore>("photons.store", 1)),
      slots_(device.array<uint32_t>("photons.slots", capacity, scratch)),
      size_(device.array<gpu::QueueSize>("photons.size", 1)),
      path_size_(device.array<gpu::QueueSize>("photons.path_size", 1)),
      in_order_(device.array<gpu::QueueSize>("photons.in_order", 1)),
      again_(device.array<gpu::QueueSize>("photons.again", 1)),
      traced_(device.array<gpu::QueueSize>("photons.traced", 1))
{
}

uint64_t PhotonStage::scratchBytes(uint32_t max_paths, uint32_t capacity)
{
    return max_paths * (sizeof(gpu::PhotonStart) + 2 * sizeof(uint32_t)) +
           capacity * (sizeof(gpu::Photon) + sizeof(gpu::PhotonTag) + sizeof(uint32_t));
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

    gpu::TraceParams params{.path_count = in.path_count,
                            .first_path = in.first_path,
                            .seed = in.seed,
                            .capacity = capacity_,
                            .bounce_limit = in.bounce_limit,
                            .caustic = caustic,
                            .again = 0};
    const std::initializer_list<Binding> bindings{{"Starts", starts_},     {"Photons", photons_}, {"Tags", tags_},
                                                  {"Appended", appended_}, {"Counts", counts_},   {"Offsets", offsets_},
                                                  {"Store", store_},       {"Slots", slots_},     {"Traced", traced_}};
    rec.clear(appended_);
    rec.clear(traced_);
    rec.run(trace_, in.path_count, params, bindings);
    rays.resize(rec, path_size_, in.path_count);
    scan_.record(rec, counts_, offsets_, total_, path_size_);
    rec.run(close_, 1, gpu::StoreParams{.path_count = in.path_count, .capacity = capacity_},
            {{"Offsets", offsets_},
             {"Total", total_},
             {"Store", store_},
             {"Size", size_},
             {"InOrder", in_order_},
             {"Again", again_}});
    rec.runIndirect(place_, in_order_, NoParams{},
                    {{"InOrder", in_order_}, {"Tags", tags_}, {"Offsets", offsets_}, {"Slots", slots_}});
    params.again = 1;
    rec.runIndirect(trace_, again_, params, bindings);
    rays.count(rec, traced_);
    return output(in.path_count);
}

PhotonStage::Output PhotonStage::output(uint32_t path_count) const
{
    return {.photons = photons_,
            .slots = slots_,
            .size = size_,
            .offsets = offsets_,
            .counts = counts_,
            .store = store_,
            .path_count = path_count,
            .capacity = capacity_};
}
