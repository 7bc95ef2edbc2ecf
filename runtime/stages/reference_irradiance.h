// Reference irradiance of irradiance samples, by path tracing. For measurements, not for frames.
#pragma once
#include "runtime/stages/reference.h"
#include "shaders/gather/gather.h"

#include <array>

class ReferenceIrradiance
{
public:
    /// @param max_samples that measure() may be given
    /// @param ray_count from each of them, rounded up to whole passes
    ReferenceIrradiance(const Device& device, const SceneGpu& scene, uint32_t max_samples, uint32_t ray_count);

    struct Estimate
    {
        std::array<double, 3> irradiance; // W/m^2: indirect light alone, as in gpu::Sample
        double standard_error;            // of the sum of the three
    };
    /// Estimates for the samples' positions and normals; waits for the device.
    /// @param depth_limit most vertices of a path, the sample itself not counted
    std::vector<Estimate> measure(std::span<const gpu::Sample> samples, uint32_t depth_limit, uint32_t seed) const;

private:
    const Device& device_;
    const SceneGpu& scene_;
    uint32_t max_samples_;
    uint32_t pass_rays_,
        pass_count_; // rays of a sample in a pass; passes are independent: their spread tells the error
    RayStage rays_;
    ReferenceStage reference_;
    Kernel generate_;
    RayQueue queue_;
    Buffer states_, directions_, no_legs_;
};
