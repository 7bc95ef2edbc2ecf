// What rays meet in a package, without any renderer.
#pragma once
#include "runtime/stages/rays.h"
#include "tools/bench/opened.h"
#include "tools/bench/reproject.h"

class Geometry
{
public:
    /// @param opened borrowed, @param max_rays of one trace()
    Geometry(const OpenedPackage& opened, uint32_t max_rays);

    /// What each ray meets first; alpha is decided by chance, but always the same for a ray's path. Waits for the
    /// device.
    std::vector<gpu::Hit> trace(std::span<const gpu::Ray> rays) const;
    /// What a picture of that camera shows in its pixels' centres.
    FirstHits firstHits(const Camera& camera, uint32_t width, uint32_t height) const;
    /// For each hit whether its surface looks the same from everywhere but for highlights: it is no mirror, no glass
    /// and not half transparent. By the materials' factors: textures are not read.
    std::vector<uint8_t> plainPixels(const FirstHits& hits) const;

private:
    const OpenedPackage& opened_;
    RayStage rays_;
    RayQueue queue_;
    Buffer hits_;
};
