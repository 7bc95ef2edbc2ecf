// Ray throughput: rays a second of the traversal kernels on a scene.
#pragma once
#include "tools/bench/opened.h"

#include <array>

struct RayBenchOptions : BenchOptions
{
    uint32_t repeats = 20; // timed runs of each kind; the median counts
};

struct RayThroughput
{
    enum Kind
    {
        kPrimary,
        kDiffuse,
        kDiffuseAnyHit,
        kKindCount
    };
    std::array<std::vector<double>, kKindCount> ms;
    std::array<uint64_t, kKindCount> rays{};

    double megaraysPerSecond(Kind kind) const { return double(rays[kind]) / percentile(ms[kind], 0.5) * 1e-3; }
};

/// Times primary closest-hit, diffuse closest-hit and diffuse any-hit rays by GPU timestamps around the traversal alone,
/// after a warm-up, the three kinds interleaved. @return kInvalid where the camera sees no surface
Result<RayThroughput> measureRays(const Device& device, const SceneGpu& scene, const Camera& camera, uint32_t width,
                                  uint32_t height, uint32_t repeats);

/// Prints Mrays/s of each kind.
Status benchRays(const RayBenchOptions& options);
