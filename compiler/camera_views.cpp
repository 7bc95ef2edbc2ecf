#include "compiler/camera_views.h"

#include "compiler/linear.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace
{
constexpr float kPi = 3.14159265f;

CameraView lookAt(std::string name, const Vec3d& eye, const Vec3d& target, float vertical_fov)
{
    CameraView view;
    view.name = std::move(name);
    view.position = eye;
    view.forward = directionOr(target - eye, {0, 0, -1});
    const gpu::vec3 world_up{0, 1, 0};
    view.up =
        normalizeOr(world_up - view.forward * dot(world_up, view.forward), {0, 0, view.forward.y > 0 ? 1.0f : -1.0f});
    view.vertical_fov = vertical_fov;
    return view;
}
} // namespace

Result<std::vector<double>> parseNumbers(const std::string& text, size_t count)
{
    std::vector<double> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (numbers.size() < count)
    {
        double value = 0;
        const auto [next, failure] = std::from_chars(at, end, value);
        if (failure != std::errc() || !std::isfinite(value))
            break;
        numbers.push_back(value);
        at = next;
        if (at == end || *at != ',')
            break;
        ++at;
    }
    if (numbers.size() != count || at != end || text.ends_with(','))
        return Error{ExitCode::kUsage, fmt::format("\"{}\" is not {} numbers separated by commas", text, count)};
    return numbers;
}

Result<CameraView> parseView(const std::string& text)
{
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        return Error{ExitCode::kUsage, fmt::format("--view \"{}\" is not NAME=EX,EY,EZ,TX,TY,TZ,YFOV", text)};
    const Result<std::vector<double>> numbers = parseNumbers(text.substr(equals + 1), 7);
    if (!numbers)
        return Error{ExitCode::kUsage,
                     fmt::format("--view: {} (NAME=EX,EY,EZ,TX,TY,TZ,YFOV)", numbers.error().message)};
    const std::vector<double>& n = *numbers;
    const Vec3d eye{n[0], n[1], n[2]};
    const Vec3d target{n[3], n[4], n[5]};
    if (eye == target)
        return Error{ExitCode::kUsage, fmt::format("--view \"{}\": eye and target are the same point", text)};
    if (!(n[6] > 0) || !(n[6] < 180))
        return Error{ExitCode::kUsage,
                     fmt::format("--view \"{}\": the field of view must lie between 0 and 180 degrees", text)};
    return lookAt(text.substr(0, equals), eye, target, float(n[6]) * kPi / 180);
}

CameraView defaultView(const Bounds& box)
{
    constexpr float kFov = kPi / 4;
    const Vec3d center = (toDouble(box.min) + toDouble(box.max)) * 0.5;
    const double radius = length(toDouble(box.max) - toDouble(box.min)) * 0.5;
    const Vec3d from = unitOrZero(Vec3d{0.6, 0.45, 1});
    return lookAt("default", center + from * (radius / std::sin(kFov / 2)), center, kFov);
}
