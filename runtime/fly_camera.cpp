#include "runtime/fly_camera.h"

#include <algorithm>
#include <cmath>

namespace
{
constexpr gpu::vec3 kWorldUp{0, 1, 0}; // glTF
constexpr float kSteepest = 0.9995f;   // of the sine of the pitch: looking straight up would leave yaw without an axis

/// Rodrigues' formula. @param axis unit
gpu::vec3 rotate(gpu::vec3 v, gpu::vec3 axis, float angle)
{
    return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + (1 - std::cos(angle)) * dot(axis, v) * axis;
}
} // namespace

FlyCamera::FlyCamera(const Camera& start, float scene_size)
    : camera_(start), slowest_(scene_size * 1e-4f), fastest_(scene_size * 10), speed_(scene_size * 0.15f)
{
}

void FlyCamera::turn(float yaw, float pitch)
{
    const auto orient = [&](gpu::vec3 axis, float angle)
    {
        camera_.forward = normalize(rotate(camera_.forward, axis, angle));
        const gpu::vec3 right = normalize(cross(camera_.forward, rotate(camera_.up, axis, angle)));
        camera_.up = cross(right, camera_.forward);
    };
    orient(kWorldUp, yaw);
    const gpu::vec3 right = cross(camera_.forward, camera_.up);
    const float steepness = std::abs(rotate(camera_.forward, right, pitch).y);
    if (steepness < kSteepest || steepness < std::abs(camera_.forward.y))
        orient(right, pitch);
}

void FlyCamera::move(const FlyInput& input, float seconds)
{
    speed_ = std::clamp(speed_ * std::pow(1.2f, input.faster), slowest_, fastest_);
    if (input.yaw != 0 || input.pitch != 0)
        turn(input.yaw, input.pitch);
    if (input.right == 0 && input.up == 0 && input.forward == 0)
        return;
    const gpu::vec3 direction =
        input.right * cross(camera_.forward, camera_.up) + input.forward * camera_.forward + input.up * kWorldUp;
    camera_.position = camera_.position + speed_ * seconds * (input.fast ? 4.0f : 1.0f) * direction;
}
