#include "runtime/stages/photon_tree.h"

PhotonTreeStage::PhotonTreeStage(const Device& device, std::string_view name, uint32_t max_slots)
    : collect_(device.kernel("photons/collect")), reorder_(device.kernel("photons/reorder")),
      compaction_(device, fmt::format("{}.compaction", name), max_slots), tree_(device, fmt::format("{}.tree", name), max_slots),
      slot_count_(device.array<gpu::QueueSize>(fmt::format("{}.slot_count", name), 1)),
      size_(device.array<gpu::QueueSize>(fmt::format("{}.size", name), 1)),
      slots_(device.array<uint32_t>(fmt::format("{}.slots", name), max_slots)),
      spheres_(device.array<gpu::vec4>(fmt::format("{}.spheres", name), max_slots)),
      sorted_(device.texelArray<gpu::Photon>(fmt::format("{}.sorted", name), max_slots))
{
}

PhotonTreeStage::Output PhotonTreeStage::record(Recorder& rec, const RayStage& rays, const PhotonStage::Output& in) const
{
    rays.resize(rec, slot_count_, in.slot_count);
    compaction_.record(rec, in.flags, slots_, size_, slot_count_);
    rec.runIndirect(collect_, size_, NoParams{},
                    {{"Size", size_}, {"Slots", slots_}, {"Photons", in.photons}, {"Spheres", spheres_}});
    tree_.record(rec, spheres_, size_);
    rec.runIndirect(reorder_, size_, NoParams{},
                    {{"Size", size_}, {"Slots", slots_}, {"Order", tree_.order()}, {"Photons", in.photons}, {"Sorted", sorted_}});
    return output();
}
