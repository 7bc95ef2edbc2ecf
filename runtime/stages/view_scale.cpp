#include "runtime/stages/view_scale.h"

#include "shaders/view_scale/measure.h"

#include <algorithm>
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
    // Half the width and height of a picture at distance 1: from there on a camera's angle is usual.
    constexpr float kUsual = 2.0f / 3;
    const float side =
        std::hypot(camera.right.x, camera.right.y, camera.right.z) + std::hypot(camera.up.x, camera.up.y, camera.up.z);
    const gpu::MeasureViewParams params{.eye = camera.position,
                                        .forward = camera.forward,
                                        .point_count = point_count,
                                        .orthographic = camera.orthographic,
                                        .size = camera.orthographic != 0 ? side : std::min(side / kUsual, 1.0f)};
    rec.run(measure_, 1, params, {{"Points", points}, {"Scale", scene_.viewScale()}});
    const Buffer& readback = readbacks_[turn_];
    turn_ = (turn_ + 1) % kFramesInFlight;
    gpu::ViewScale last{};
    std::memcpy(&last, readback.mapped().data(), sizeof(last));
    last_distance_ = last.distance;
    rec.copy(scene_.viewScale(), readback, sizeof(gpu::ViewScale));
}
