#include "runtime/stages/reference_irradiance.h"

#include "shaders/legs/legs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace
{
constexpr uint32_t kLeastPasses = 16;
constexpr uint32_t kPassPaths = 1u << 20; // what a pass holds memory for

uint32_t raysOfPass(uint32_t max_samples, uint32_t ray_count)
{
    return std::clamp(kPassPaths / max_samples, 1u, (ray_count + kLeastPasses - 1) / kLeastPasses);
}

struct Sum // of a sample, over passes
{
    std::array<double, 3> irradiance{};
    double squares = 0; // of the sum of the three channels

    /// `paths`: radiance along rays that are distributed by the cosine, so that E = pi x mean.
    void add(std::span<const gpu::vec3> paths)
    {
        std::array<double, 3> pass{};
        for (const gpu::vec3& path : paths)
            pass[0] += double(path.x), pass[1] += double(path.y), pass[2] += double(path.z);
        double total = 0;
        for (size_t channel = 0; channel < 3; ++channel)
        {
            pass[channel] *= std::numbers::pi / double(paths.size());
            irradiance[channel] += pass[channel];
            total += pass[channel];
        }
        squares += total * total;
    }

    ReferenceIrradiance::Estimate estimate(double passes) const
    {
        ReferenceIrradiance::Estimate mean{};
        double total = 0;
        for (size_t channel = 0; channel < 3; ++channel)
            total += mean.irradiance[channel] = irradiance[channel] / passes;
        mean.standard_error = std::sqrt(std::max(0.0, squares / passes - total * total) / (passes - 1));
        return mean;
    }
};
} // namespace

ReferenceIrradiance::ReferenceIrradiance(const Device& device, const SceneGpu& scene, uint32_t max_samples,
                                         uint32_t ray_count)
    : device_(device), scene_(scene), max_samples_(max_samples), pass_rays_(raysOfPass(max_samples, ray_count)),
      pass_count_(std::max((ray_count + pass_rays_ - 1) / pass_rays_, 2u)), rays_(device, scene),
      reference_(device, scene, max_samples, pass_rays_), generate_(device.kernel("gather/generate")),
      queue_(device, "reference_irradiance.queue", max_samples * pass_rays_),
      states_(device.array<gpu::GatherState>("reference_irradiance.states", uint64_t(max_samples) * pass_rays_)),
      directions_(device.array<uint32_t>("reference_irradiance.directions", uint64_t(max_samples) * pass_rays_)),
      no_legs_(device.texelArray<gpu::Leg>("reference_irradiance.no_legs", gpu::kLegCount))
{
}

std::vector<ReferenceIrradiance::Estimate> ReferenceIrradiance::measure(std::span<const gpu::Sample> samples,
                                                                        uint32_t depth_limit, uint32_t seed) const
{
    const uint32_t count = uint32_t(samples.size()), path_count = count * pass_rays_;
    check(count > 0 && count <= max_samples_, "{} samples where at most {} were promised", count, max_samples_);
    const Buffer points = device_.upload("reference_irradiance.samples", samples);
    const gpu::QueueSize queue_size = gpu::queueSize(count);
    const Buffer size = device_.upload("reference_irradiance.size", std::span(&queue_size, 1));
    std::vector<Sum> sums(count);
    Recorder rec(device_);
    for (uint32_t pass = 0; pass < pass_count_; ++pass)
    {
        rec.begin(scene_.descriptorSet());
        rec.run(generate_, count * gpu::kRaysGroupSize,
                gpu::GatherParams{.ray_count = pass_rays_, .seed = traceSeed(seed, pass, 0)},
                {{"Size", size},
                 {"Samples", points},
                 {"Queue", queue_.size},
                 {"Rays", queue_.rays},
                 {"States", states_},
                 {"Legs", no_legs_},
                 {"Directions", directions_}});
        const Buffer& radiance = reference_.recordLeft(
            rec, rays_,
            {.rays = queue_, .path_count = path_count, .depth_limit = depth_limit, .seed = traceSeed(seed, pass, 1)});
        rec.submitAndWait();
        const std::vector<gpu::vec3> paths = device_.download<gpu::vec3>(radiance, path_count);
        for (uint32_t i = 0; i < count; ++i)
            sums[i].add(std::span(paths).subspan(size_t(i) * pass_rays_, pass_rays_));
    }
    std::vector<Estimate> estimates;
    for (const Sum& sum : sums)
        estimates.push_back(sum.estimate(pass_count_));
    return estimates;
}
