// Ray throughput: how many rays a second the traversal kernels do on a scene.
#pragma once
#include "format/result.h"

#include <cstdint>
#include <filesystem>
#include <string>

struct RayBenchOptions
{
    std::filesystem::path package;
    uint32_t width = 1920;
    uint32_t height = 1080;
    uint32_t repeats = 20; // timed runs of each kind; the median counts
    std::string camera;
    std::string device;
    bool json = false;
};

/// Prints Mrays/s for primary closest-hit, diffuse closest-hit and diffuse any-hit rays, measured by GPU timestamps
/// around the traversal alone, after a warm-up, the three kinds interleaved.
Status benchRays(const RayBenchOptions& options);
