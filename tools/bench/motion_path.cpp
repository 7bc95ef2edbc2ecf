#include "tools/bench/motion_path.h"

#include "runtime/camera_path.h"
#include "tools/bench/paths.h"

#include <algorithm>
#include <limits>

namespace
{
/// Metres to what is met; infinite where that is nothing.
std::vector<float> distances(const Geometry& geometry, std::span<const gpu::Ray> rays)
{
    std::vector<float> result;
    for (const gpu::Hit& hit : geometry.trace(rays))
        result.push_back(hit.slot == gpu::kNone ? std::numeric_limits<float>::infinity() : hit.t);
    return result;
}

/// Of the surface in the picture's centre, or, where there is none, the median of all; infinite where the camera sees
/// none.
float viewDistance(const Geometry& geometry, const Camera& camera)
{
    constexpr uint32_t kWidth = 33, kHeight = 19; // odd: one ray goes through the centre
    std::vector<float> all = distances(geometry, centerRays(cameraParams(camera, kWidth, kHeight)));
    const float center = all[kHeight / 2 * kWidth + kWidth / 2];
    if (std::isfinite(center))
        return center;
    std::erase_if(all, [](float distance) { return !std::isfinite(distance); });
    return all.empty() ? center : float(percentile({all.begin(), all.end()}, 0.5));
}

Result<CameraOfFrame> orbit(double frames_per_second, const Camera& camera, const Geometry& geometry)
{
    const gpu::vec3 right = cross(camera.forward, camera.up);
    const float ahead = viewDistance(geometry, camera), endless = std::numeric_limits<float>::infinity();
    if (!std::isfinite(ahead))
        return Error{ExitCode::kInvalid,
                     "the camera sees no surface that it could orbit; choose another with --camera"};
    const std::array rays{gpu::Ray{camera.position, endless, -1 * right, 0},
                          gpu::Ray{camera.position, endless, right, 1}};
    const std::vector<float> beside = distances(geometry, rays);
    const float radius = orbitRadius(ahead, beside[0], beside[1]);
    return CameraOfFrame([=](int32_t frame)
                         { return orbitingCamera(camera, radius, float(frame / frames_per_second)); });
}
} // namespace

Result<CameraOfFrame> chooseMotion(const std::string& path, double frames_per_second, const OpenedPackage& opened,
                                   const Geometry& geometry)
{
    constexpr double kSwayPerSecond = 30; // its frames
    if (path == "orbit")
        return orbit(frames_per_second, opened.camera, geometry);
    if (path == "sway")
        return CameraOfFrame(
            [&opened, frames_per_second](int32_t frame) {
                return movedCamera(opened.camera, opened.scene->info(),
                                   float(frame * kSwayPerSecond / frames_per_second));
            });
    const auto read = CameraPath::load(path, packageCameras(opened.package));
    if (!read)
        return read.error().about(path);
    return CameraOfFrame([read = *read, frames_per_second](int32_t frame)
                         { return read.at(read.start() + std::abs(frame) / frames_per_second); });
}
