#include "tools/bench/geometry.h"

namespace
{
/// Roughness from which a reflection is blurred over a tenth of the view and more, so that it hardly moves on its
/// surface.
constexpr float kRough = 0.4f;

bool isPlain(const gpu::Material& material)
{
    const bool reflects = material.metallic > 0 || material.specular > 0;
    const bool coated = material.clearcoat > 0 && material.clearcoat_roughness < kRough;
    return material.transmission == 0 && !coated && !(reflects && material.roughness < kRough) &&
           (material.flags & gpu::kMaterialAlphaBlend) == 0;
}
} // namespace

Geometry::Geometry(const OpenedPackage& opened, uint32_t max_rays)
    : opened_(opened), rays_(*opened.device, *opened.scene), queue_(*opened.device, "bench.geometry", max_rays),
      hits_(opened.device->array<gpu::Hit>("bench.geometry.hits", max_rays))
{
}

std::vector<gpu::Hit> Geometry::trace(std::span<const gpu::Ray> rays) const
{
    const Device& device = *opened_.device;
    const Buffer uploaded = device.upload("bench.geometry.uploaded", rays);
    Recorder rec(device);
    rec.begin(opened_.scene->descriptorSet());
    rays_.resize(rec, queue_.size, uint32_t(rays.size()));
    rec.copy(uploaded, queue_.rays, rays.size_bytes());
    rays_.closest(rec, queue_, hits_, 0);
    rec.submitAndWait();
    return device.download<gpu::Hit>(hits_, rays.size());
}

FirstHits Geometry::firstHits(const Camera& camera, uint32_t width, uint32_t height) const
{
    const gpu::CameraParams params = cameraParams(camera, width, height);
    const auto at_rest = opened_.package.bvhTriangles();
    if (!opened_.scene->canMove())
        return ::firstHits(params, trace(centerRays(params)), at_rest);
    const auto now =
        opened_.device->download<gpu::BvhTriangle>(opened_.scene->buffer(gpu::kBvhTrianglesBinding), at_rest.size());
    return ::firstHits(params, trace(centerRays(params)), now);
}

std::vector<uint8_t> Geometry::plainPixels(const FirstHits& hits) const
{
    std::vector<uint8_t> plain;
    plain.reserve(hits.hits.size());
    for (const FirstHit& hit : hits.hits)
        plain.push_back(hit.isSky() ||
                        isPlain(opened_.package.materials()[opened_.package.bvhTriangles()[hit.slot].material]));
    return plain;
}
