#include "tests/stages/shading_points.h"

namespace
{
/// The surface that lib/surface.glsl makes of a shading point; without textures.
ShadingPoints::Point pointAt(const package::Package& package, const gpu::ShadingPoint& from)
{
    if (from.slot == gpu::kNone)
        return {.exists = false, .position = {}, .normal = {}, .diffuse = {}, .throughput = {}};
    const gpu::BvhTriangle& t = package.bvhTriangles()[from.slot];
    const gpu::uvec3 v = package.triangles()[t.triangle].vertices;
    const double u = from.barycentrics.x, w = from.barycentrics.y;
    const auto interpolated = [&](Double3 a, Double3 b, Double3 c) { return (1 - u - w) * a + u * b + w * c; };
    const auto normalOf = [&](uint32_t vertex) { return unpackedNormal(package.vertexAttributes()[vertex].normal); };
    const Double3 a = t.v0, ab = Double3(t.v1) - a, ac = Double3(t.v2) - a, direction = from.direction;
    const Double3 facing{ab.y * ac.z - ab.z * ac.y, ab.z * ac.x - ab.x * ac.z, ab.x * ac.y - ab.y * ac.x};
    Double3 normal = normalized(interpolated(normalOf(v.x), normalOf(v.y), normalOf(v.z)));
    if (dot(facing, direction) >= 0)
        normal = -1 * normal;
    const gpu::Material& m = package.materials()[t.material];
    return {.exists = true,
            .position = interpolated(t.v0, t.v1, t.v2),
            .normal = normal,
            .diffuse = (1 - m.metallic) * (1 - m.transmission) * Double3(m.base_color),
            .throughput = from.throughput};
}
} // namespace

ShadingPoints::ShadingPoints(const Device& device, const SceneGpu& scene, const std::filesystem::path& path,
                             const Camera& camera, uint32_t width_, uint32_t height_)
    : width(width_), height(height_), stage(device, scene, width * height),
      emission(device.array<gpu::vec3>("test.emission", width_ * height_))
{
    const auto package = package::Package::open(path);
    check(bool(package), "{}", path.string());
    const RayStage rays(device, scene);
    gpu::CameraParams view = cameraParams(camera, width, height);
    view.sample_count = 1;
    Recorder rec(device);
    rec.begin(scene.descriptorSet());
    gpu.emplace(stage.record(rec, rays, {.camera = view, .specular_depth = 4, .emission = emission}));
    rec.submitAndWait();
    for (const gpu::ShadingPoint& point : device.download<gpu::ShadingPoint>(gpu->points, width * height))
        points.push_back(pointAt(*package, point));
}
