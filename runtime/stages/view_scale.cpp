#include "runtime/stages/view_scale.h"

#include <cmath>
#include <cstring>

ViewScaleStage::ViewScaleStage(const Device& device, const SceneGpu& scene)
    : scene_(scene), measure_(device.kernel("view_scale/measure"))
{
    for (Buffer& readback : readbacks_)
    {
        readback = device.readback("view_scale.readback", sizeof(gpu::ViewScale));
        std::memset(readback.mapped().data(), 0, readback.mapped().size());
    }
}

void ViewScaleStage::record(Recorder& rec, const Buffer& points, uint32_t point_count, const gpu::CameraParams& camera)
{
    // An orthographic camera may be at any distance: the scale is the size of its picture.
    const gpu::vec3 r = camera.right, u = camera.up;
    const float side = std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z) + std::sqrt(u.x * u.x + u.y * u.y + u.z * u.z);
    const gpu::MeasureParams params{
        .focus = camera.position, .point_count = point_count, .fixed_distance = camera.orthographic != 0 ? side : 0};
    rec.run(measure_, 1, params, {{"Points", points}, {"Scale", scene_.viewScale()}});
    const Buffer& readback = readbacks_[turn_];
    turn_ = (turn_ + 1) % kFramesInFlight;
    gpu::ViewScale last{};
    std::memcpy(&last, readback.mapped().data(), sizeof(last));
    last_distance_ = last.distance;
    rec.copy(scene_.viewScale(), readback, sizeof(gpu::ViewScale));
}
