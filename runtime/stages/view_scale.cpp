#include "runtime/stages/view_scale.h"

#include <cmath>
#include <cstring>

ViewScaleStage::ViewScaleStage(const Device& device, const SceneGpu& scene)
    : scene_(scene), measure_(device.kernel("view_scale/measure")),
      readback_(device.readback("view_scale.readback", sizeof(gpu::ViewScale)))
{
    std::memset(readback_.mapped().data(), 0, readback_.mapped().size());
}

void ViewScaleStage::record(Recorder& rec, const Buffer& points, uint32_t point_count,
                            const gpu::CameraParams& camera) const
{
    // An orthographic camera may be at any distance: the scale is the size of its picture.
    const gpu::vec3 r = camera.right, u = camera.up;
    const float side = std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z) + std::sqrt(u.x * u.x + u.y * u.y + u.z * u.z);
    const gpu::MeasureParams params{
        .focus = camera.position, .point_count = point_count, .fixed_distance = camera.orthographic != 0 ? side : 0};
    rec.run(measure_, 1, params, {{"Points", points}, {"Scale", scene_.viewScale()}});
    rec.copy(scene_.viewScale(), readback_, sizeof(gpu::ViewScale));
}

float ViewScaleStage::lastDistance() const
{
    gpu::ViewScale scale{};
    std::memcpy(&scale, readback_.mapped().data(), sizeof(scale));
    return scale.distance;
}
