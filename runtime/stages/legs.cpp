#include "runtime/stages/legs.h"

LegsStage::LegsStage(const Device& device)
    : pick_(device.kernel("legs/pick")), legs_(device.texelArray<gpu::Leg>("legs.legs", gpu::kLegCount))
{
}

void LegsStage::record(Recorder& rec, const StoredPhotons& map, uint32_t seed) const
{
    rec.run(pick_, gpu::kLegCount, gpu::LegParams{.seed = seed},
            {{"Photons", map.photons},
             {"Slots", map.slots},
             {"Offsets", map.offsets},
             {"Counts", map.counts},
             {"Store", map.store},
             {"Legs", legs_}});
}
