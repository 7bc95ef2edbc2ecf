#include "runtime/camera.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

float pixelSide(const gpu::CameraParams& camera)
{
    return 2 * std::hypot(camera.right.x, camera.right.y, camera.right.z) / float(camera.width);
}

gpu::vec3 operator+(gpu::vec3 a, gpu::vec3 b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
gpu::vec3 operator*(float s, gpu::vec3 v)
{
    return {s * v.x, s * v.y, s * v.z};
}
float dot(gpu::vec3 a, gpu::vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
gpu::vec3 cross(gpu::vec3 a, gpu::vec3 b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
gpu::vec3 normalize(gpu::vec3 v)
{
    return (1 / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z)) * v;
}

std::vector<Camera> packageCameras(const package::Package& package)
{
    const auto vec = [](const lumicut::fb::Vec3* v) { return gpu::vec3{v->x(), v->y(), v->z()}; };
    std::vector<Camera> cameras;
    for (const auto* camera : *package.meta().cameras())
        cameras.push_back({.name = camera->name() ? camera->name()->str() : "",
                           .position = vec(camera->position()),
                           .forward = vec(camera->forward()),
                           .up = vec(camera->up()),
                           .vertical_fov = camera->vertical_fov(),
                           .orthographic_height = camera->orthographic_height(),
                           .near_plane = camera->near_plane(),
                           .far_plane = camera->far_plane()});
    return cameras;
}

std::optional<size_t> findCamera(const std::vector<Camera>& cameras, const std::string& name_or_index)
{
    if (const auto named = std::ranges::find(cameras, name_or_index, &Camera::name); named != cameras.end())
        return size_t(named - cameras.begin());
    size_t index = 0;
    const char* end = name_or_index.data() + name_or_index.size();
    const auto [stop, error] = std::from_chars(name_or_index.data(), end, index);
    if (error != std::errc() || stop != end || index >= cameras.size())
        return std::nullopt;
    return index;
}

std::string noCamera(const std::vector<Camera>& cameras, const std::string& name_or_index)
{
    std::string names;
    for (size_t i = 0; i < cameras.size(); ++i)
        names += fmt::format("{}{} ({})", i ? ", " : "", cameras[i].name, i);
    return fmt::format("there is no camera '{}'; the package has {}", name_or_index, names);
}

Result<size_t> chooseCamera(const std::vector<Camera>& cameras, const std::string& name_or_index)
{
    if (name_or_index.empty())
        return size_t(0);
    if (const auto camera = findCamera(cameras, name_or_index))
        return *camera;
    return Error{ExitCode::kUsage, noCamera(cameras, name_or_index)};
}

gpu::CameraParams cameraParams(const Camera& camera, uint32_t width, uint32_t height)
{
    const bool orthographic = camera.orthographic_height > 0;
    const float half_height = orthographic ? 0.5f * camera.orthographic_height : std::tan(0.5f * camera.vertical_fov);
    const float half_width = half_height * float(width) / float(height);
    return {.position = camera.position,
            .right = half_width * normalize(cross(camera.forward, camera.up)),
            .up = half_height * camera.up,
            .forward = camera.forward,
            .width = width,
            .height = height,
            .orthographic = orthographic,
            .near_plane = camera.near_plane,
            .far_plane = camera.far_plane,
            .sample_count = 1,
            .first_sample = 0,
            .seed = 0,
            .jitter = {}};
}
