// Whatever a camera path says: it ends in an error or in cameras that can be rendered.
#include "format/check.h"
#include "format/vec3d.h"
#include "runtime/camera_path.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    const std::vector<Camera> cameras = {{.name = "hall"},
                                         {.name = "plan", .vertical_fov = 0, .orthographic_height = 2}};
    const auto path = CameraPath::parse({reinterpret_cast<const char*>(data), size}, cameras);
    if (!path)
        return 0;
    for (int step = -1; step <= 20; ++step)
    {
        const double time = path->start() + (path->end() - path->start()) * step / 19;
        const Camera camera = path->at(time);
        const Vec3d forward = toDouble(camera.forward), up = toDouble(camera.up);
        check(isFinite(toDouble(camera.position)), "position at {}", time);
        check(std::abs(length(forward) - 1) < 1e-5 && std::abs(length(up) - 1) < 1e-5 &&
                  std::abs(dot(forward, up)) < 1e-5,
              "axes at {}", time);
        check((camera.vertical_fov > 0) != (camera.orthographic_height > 0), "lens at {}", time);
    }
    return 0;
}
