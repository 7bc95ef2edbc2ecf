// Segments (legs) of photons' paths from one surface to another. Gathering rays are aimed along those that arrived nearby.
#pragma once
#include "runtime/stages/stored_photons.h"
#include "shaders/legs/legs.h"

class LegsStage
{
public:
    explicit LegsStage(const Device& device);

    /// Samples kLegCount legs of a map in proportion to their power.
    void record(Recorder& rec, const StoredPhotons& map, uint32_t seed) const;
    /// gpu::Leg[kLegCount] of the last record()
    const Buffer& legs() const { return legs_; }

private:
    Kernel pick_;
    Buffer legs_;
};
