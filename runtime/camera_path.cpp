#include "runtime/camera_path.h"

#include "format/check.h"
#include "format/temporary_file.h"
#include "runtime/rotation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace
{
Rotation orientation(const Camera& camera)
{
    const Vec3d forward = unitOrZero(toDouble(camera.forward));
    const Vec3d right = unitOrZero(cross(forward, toDouble(camera.up)));
    return rotationTo(right, cross(right, forward), forward * -1);
}

bool isPerspective(const Camera& camera)
{
    return camera.vertical_fov > 0;
}

/// How a curve goes from one key to the next, as a Bezier curve: the three steps between its control points.
struct Steps
{
    double h; // seconds from key to key
    Vec3d slope_in, slope_out, change;

    Vec3d first() const { return slope_in * (h / 3); }
    Vec3d last() const { return slope_out * (h / 3); }
};

/// What of each step has been gone at s, 0 to 1: sums of Bernstein polynomials.
struct Progress
{
    double first, middle, last;

    explicit Progress(double s) : first(1 - (1 - s) * (1 - s) * (1 - s)), middle(s * s * (3 - 2 * s)), last(s * s * s)
    {
    }
};

/// At a key, the mean speed from the one before to the one after; 0 where it is the same as one of them. (The slope of the
/// parabola through all three would be nearer to even acceleration, but carries a short, fast move far into a long, slow one.)
/// @param before, after changes from the key before and to the one after, over `seconds` in all
Vec3d slope(const Vec3d& before, const Vec3d& after, double seconds)
{
    return before == Vec3d{} || after == Vec3d{} ? Vec3d{} : (before + after) * (1 / seconds);
}

/// Steps from key `i` to the next. `change(j)`: from key j to the next, of what moves.
template <typename Change>
Steps steps(const std::vector<CameraKey>& keys, size_t i, const Change& change)
{
    const auto h = [&](size_t j) { return keys[j + 1].time - keys[j].time; };
    const Vec3d here = change(i);
    const Vec3d mean = here * (1 / h(i)); // at the path's ends
    return {.h = h(i),
            .slope_in = i > 0 ? slope(change(i - 1), here, h(i - 1) + h(i)) : mean,
            .slope_out = i + 2 < keys.size() ? slope(here, change(i + 1), h(i) + h(i + 1)) : mean,
            .change = here};
}

Vec3d positionAt(const std::vector<CameraKey>& keys, size_t i, double s)
{
    const auto position = [&](size_t j) { return toDouble(keys[j].camera.position); };
    const Steps to = steps(keys, i, [&](size_t j) { return position(j + 1) - position(j); });
    const Progress gone(s);
    const Vec3d middle = to.change - to.first() - to.last();
    return position(i) + to.first() * gone.first + middle * gone.middle + to.last() * gone.last;
}

/// The same with rotations for steps (Kim, Kim and Shin 1995: "A General Construction Scheme for Unit Quaternion
/// Curves").
Rotation orientationAt(const std::vector<CameraKey>& keys, size_t i, double s)
{
    const auto turn = [&](size_t j) { return inverse(orientation(keys[j].camera)) * orientation(keys[j + 1].camera); };
    // A rotation's vector is the same before and after that rotation: those of two neighbours may be added at the key
    // between them.
    const Steps to = steps(keys, i, [&](size_t j) { return logarithm(turn(j)); });
    const Progress gone(s);
    const Vec3d middle = logarithm(exponential(to.first() * -1) * turn(i) * exponential(to.last() * -1));
    return orientation(keys[i].camera) * exponential(to.first() * gone.first) * exponential(middle * gone.middle) *
           exponential(to.last() * gone.last);
}

/// A member of Camera between two keys; never beyond either.
float between(const std::vector<CameraKey>& keys, size_t i, double s, float Camera::*member)
{
    const auto value = [&](size_t j) { return double(keys[j].camera.*member); };
    const Steps to = steps(keys, i, [&](size_t j) { return Vec3d{value(j + 1) - value(j), 0, 0}; });
    const Progress gone(s);
    const double first = to.first().x, last = to.last().x;
    const double there = value(i) + first * gone.first + (to.change.x - first - last) * gone.middle + last * gone.last;
    return float(std::clamp(there, std::min(value(i), value(i + 1)), std::max(value(i), value(i + 1))));
}
} // namespace

CameraPath::CameraPath(std::vector<CameraKey> keys) : keys_(std::move(keys))
{
    check(!keys_.empty(), "a path without keys");
    for (size_t i = 1; i < keys_.size(); ++i)
        check(keys_[i].time - keys_[i - 1].time >= kLeastStep, "key {} at {} s, {} at {} s", i - 1, keys_[i - 1].time,
              i, keys_[i].time);
}

Camera CameraPath::at(double seconds) const
{
    if (!(seconds > start()))
        return keys_.front().camera;
    if (seconds >= end())
        return keys_.back().camera;
    const auto after = std::ranges::upper_bound(keys_, seconds, {}, &CameraKey::time);
    const size_t i = size_t(after - keys_.begin()) - 1;
    const Camera &a = keys_[i].camera, &b = keys_[i + 1].camera;
    const double s = (seconds - keys_[i].time) / (keys_[i + 1].time - keys_[i].time);

    Camera camera = a;
    camera.position = toFloat(positionAt(keys_, i, s));
    const Rotation turned = orientationAt(keys_, i, s);
    camera.forward = toFloat(unitOrZero(rotate(turned, {0, 0, -1})));
    camera.up = toFloat(unitOrZero(rotate(turned, {0, 1, 0})));
    if (isPerspective(a) == isPerspective(b))
    {
        camera.vertical_fov = between(keys_, i, s, &Camera::vertical_fov);
        camera.orthographic_height = between(keys_, i, s, &Camera::orthographic_height);
    }
    camera.near_plane = std::lerp(a.near_plane, b.near_plane, float(s));
    camera.far_plane = a.far_plane > 0 && b.far_plane > 0 ? std::lerp(a.far_plane, b.far_plane, float(s)) : 0;
    return camera;
}

Status CameraPath::save(const std::filesystem::path& path) const
{
    const auto vector = [](gpu::vec3 v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); };
    std::string text = "{\n  \"schema\": \"lumicut-path/1\",\n  \"keys\": [";
    for (size_t i = 0; i < keys_.size(); ++i)
    {
        const Camera& camera = keys_[i].camera;
        text += fmt::format("{}\n    {{\"time\": {}, \"position\": {}, \"forward\": {}, \"up\": {}, ", i ? "," : "",
                            keys_[i].time, vector(camera.position), vector(camera.forward), vector(camera.up));
        text += isPerspective(camera) ? fmt::format("\"vertical_fov\": {}", camera.vertical_fov)
                                      : fmt::format("\"orthographic_height\": {}", camera.orthographic_height);
        text += fmt::format(", \"near_plane\": {}, \"far_plane\": {}}}", camera.near_plane, camera.far_plane);
    }
    text += "\n  ]\n}\n";
    TemporaryFile file(path);
    if (!file.isOpen() || !file.append(std::as_bytes(std::span(text))) || !file.commit())
        return Error{ExitCode::kIo, fmt::format("the path cannot be written: {}", std::strerror(errno)), path.string()};
    return Success{};
}
