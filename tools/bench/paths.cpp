#include "tools/bench/paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace
{
constexpr float kDegree = std::numbers::pi_v<float> / 180;

/// @param axis of unit length
gpu::vec3 turned(gpu::vec3 v, gpu::vec3 axis, float radians)
{
    const float c = std::cos(radians), s = std::sin(radians);
    return c * v + s * cross(axis, v) + (dot(axis, v) * (1 - c)) * axis;
}

float diagonal(const gpu::SceneInfo& info)
{
    const gpu::vec3 extent = info.bounds_max + -1 * info.bounds_min;
    return std::sqrt(dot(extent, extent));
}
} // namespace

Camera movedCamera(const Camera& camera, const gpu::SceneInfo& info, float frame)
{
    const float phase = frame * 3 * kDegree, radius = diagonal(info) / 400;
    Camera moved = camera;
    moved.forward = turned(camera.forward, camera.up, 5 * kDegree * std::sin(phase));
    const gpu::vec3 right = cross(camera.forward, camera.up);
    moved.position =
        camera.position + (radius * (std::cos(phase) - 1)) * right + (radius * std::sin(phase)) * camera.up;
    return moved;
}

Camera orbitingCamera(const Camera& camera, float radius, float seconds)
{
    const gpu::vec3 center = camera.position + std::abs(radius) * camera.forward;
    Camera moved = camera;
    moved.forward = turned(camera.forward, camera.up, std::copysign(20 * kDegree, radius) * seconds);
    moved.position = center + -std::abs(radius) * moved.forward;
    return moved;
}

float orbitRadius(float ahead, float left, float right)
{
    constexpr float kRoom = 0.9f; // of that beside the camera
    const float radius = std::min(0.5f * ahead, kRoom * std::max(left, right));
    return right >= left ? radius : -radius;
}

gpu::Light movedLight(const gpu::Light& light, const gpu::SceneInfo& info, int32_t frame)
{
    gpu::Light moved = light;
    if (light.kind == gpu::kLightDirectional)
    {
        const gpu::vec3 axis = std::abs(light.p1.y) < 0.99f ? gpu::vec3{0, 1, 0} : gpu::vec3{1, 0, 0};
        moved.p1 = turned(light.p1, axis, float(frame) * kDegree);
        return moved;
    }
    const float phase = float(frame) * 3 * kDegree, radius = diagonal(info) / 200;
    moved.p0 = light.p0 + gpu::vec3{radius * std::cos(phase), 0, radius * std::sin(phase)};
    return moved;
}
