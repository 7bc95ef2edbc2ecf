#include "runtime/stages/photon_tree.h"

PhotonTreeStage::PhotonTreeStage(const Device& device, std::string_view name, uint32_t max_photons,
                                 const Scratch& scratch)
    : keys_(device.kernel("photons/keys")), reorder_(device.kernel("photons/reorder")),
      tree_(device, fmt::format("{}.tree", name), max_photons, scratch),
      size_(device.array<gpu::QueueSize>(fmt::format("{}.size", name), 1)),
      spheres_(device.array<gpu::vec4>(fmt::format("{}.spheres", name), max_photons, scratch)),
      sorted_(device.texelArray<gpu::Photon>(fmt::format("{}.sorted", name), max_photons))
{
}

uint64_t PhotonTreeStage::scratchBytes(const Device& device, uint32_t max_photons)
{
    return Tree::scratchBytes(device, max_photons) + max_photons * sizeof(gpu::vec4);
}

PhotonTreeStage::Output PhotonTreeStage::record(Recorder& rec, const PhotonStage::Output& in) const
{
    rec.copy(in.size, size_, sizeof(gpu::QueueSize));
    rec.runIndirect(keys_, size_, NoParams{},
                    {{"Size", size_},
                     {"Slots", in.slots},
                     {"Photons", in.photons},
                     {"Spheres", spheres_},
                     {"Keys", tree_.keys()},
                     {"Order", tree_.order()}});
    tree_.recordKeyed(rec, spheres_, size_, 32);
    rec.runIndirect(
        reorder_, size_, NoParams{},
        {{"Size", size_}, {"Slots", in.slots}, {"Order", tree_.order()}, {"Photons", in.photons}, {"Sorted", sorted_}});
    return output();
}
