// Sums of samples that do not depend on the order, or on how samples are split over runs.
#pragma once
#include "runtime/gpu/gpu.h"
#include "shaders/resolve/exact_sum.h"

class ExactSumStage
{
public:
    ExactSumStage(const Device& device, uint32_t pixel_count);

    /// Empties the sums. Once, before the first of record().
    void clear(Recorder& rec) const;
    /// Adds samples first to last - 1 of each pixel. @param radiance vec3[samples * pixel_count], W/(m^2 sr)
    void record(Recorder& rec, const Buffer& radiance, uint32_t first, uint32_t last) const;

    /// uint[4 * 3 * pixel_count], see shaders/resolve/exact_sum.h
    const Buffer& sums() const { return sums_; }
    /// uint: samples left out because they were NaN or infinite
    const Buffer& nonFiniteCount() const { return non_finite_; }

private:
    Kernel add_;
    uint32_t pixel_count_;
    Buffer sums_, non_finite_;
};
