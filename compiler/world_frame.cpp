#include "compiler/world_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace
{
constexpr double kFarthest = 64;  // sizes between centre and origin: coordinates keep 18 bits of the size
constexpr double kNearObject = 8; // sizes between centre and the object whose origin becomes the scene's
constexpr int kOriginBits = 17;   // of an origin that is no object's: few, so that differences from it are exact
// Exponents of 2 of sizes in metres. Areas squared, of details of a millionth and of surroundings of a thousand times
// the size, are then normal floats, and shaders compute with those.
constexpr int kSmallest = -10;
constexpr int kLargest = 20;
constexpr size_t kMostSamples = 1u << 18;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Box
{
    Vec3d low{kInfinity, kInfinity, kInfinity};
    Vec3d high{-kInfinity, -kInfinity, -kInfinity};

    void grow(const Vec3d& p)
    {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    Vec3d nearest(const Vec3d& p) const
    {
        const auto within = [](double v, double least, double most) { return std::max(least, std::min(v, most)); };
        return {within(p.x, low.x, high.x), within(p.y, low.y, high.y), within(p.z, low.z, high.z)};
    }
};

double median(std::vector<double> values)
{
    const auto middle = values.begin() + ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Vec3d median(const std::vector<Vec3d>& points)
{
    const auto along = [&](double Vec3d::*axis)
    {
        std::vector<double> values;
        for (const Vec3d& p : points)
            values.push_back(p.*axis);
        return median(std::move(values));
    };
    return {along(&Vec3d::x), along(&Vec3d::y), along(&Vec3d::z)};
}

/// Calls visit(primitive, to_world) for every primitive of every instance.
template <typename Visit>
void forEachPrimitive(const ImportedScene& imported, const Visit& visit)
{
    for (const ImportedInstance& instance : imported.instances)
        for (size_t p = 0; p < instance.primitive_count; ++p)
            visit(imported.primitives[instance.first_primitive + p], instance.to_world);
}

/// The corners of every triangle, or of every n-th of many.
std::vector<Vec3d> sampleTriangles(const ImportedScene& imported)
{
    size_t total = 0;
    forEachPrimitive(imported, [&](const MeshPrimitive& p, const Transform&) { total += p.triangles.size(); });
    const size_t stride = 1 + total / kMostSamples;
    std::vector<Vec3d> samples;
    size_t next = 0; // index of the next sample's triangle in this primitive
    forEachPrimitive(imported,
                     [&](const MeshPrimitive& primitive, const Transform& to_world)
                     {
                         for (; next < primitive.triangles.size(); next += stride)
                         {
                             const gpu::uvec3 t = primitive.triangles[next];
                             for (const uint32_t v : {t.x, t.y, t.z})
                                 if (const Vec3d p = to_world.point(toDouble(primitive.positions[v])); isFinite(p))
                                     samples.push_back(p);
                         }
                         next -= primitive.triangles.size();
                     });
    return samples;
}

Box boxOf(const MeshPrimitive& primitive)
{
    Box box;
    for (const gpu::vec3 p : primitive.positions)
        box.grow(toDouble(p));
    return box;
}

/// A box about `local` in world space.
Box transformed(const Box& local, const Transform& to_world)
{
    Box box;
    for (unsigned corner = 0; corner < 8; ++corner)
        box.grow(to_world.point({(corner & 1) != 0 ? local.high.x : local.low.x,
                                 (corner & 2) != 0 ? local.high.y : local.low.y,
                                 (corner & 4) != 0 ? local.high.z : local.low.z}));
    return box;
}

/// The place in the scene's objects next to `from`.
Vec3d nearestPlace(const ImportedScene& imported, const Vec3d& from)
{
    std::vector<Box> local;
    for (const MeshPrimitive& primitive : imported.primitives)
        local.push_back(boxOf(primitive));
    Vec3d best = from;
    double least = kInfinity;
    forEachPrimitive(imported,
                     [&](const MeshPrimitive& primitive, const Transform& to_world)
                     {
                         if (primitive.triangles.empty())
                             return;
                         const Box& box = local[size_t(&primitive - imported.primitives.data())];
                         const Vec3d place = transformed(box, to_world).nearest(from);
                         if (const double distance = length(place - from); distance < least)
                         {
                             least = distance;
                             best = place;
                         }
                     });
    return best;
}

/// Where precision is needed: at the part of the scene nearest to the cameras. A camera itself may be far from what it shows
/// (an orthographic one anywhere).
Vec3d centerOf(const ImportedScene& imported, const std::vector<Vec3d>& samples)
{
    if (imported.scene.cameras.empty())
        return median(samples);
    std::vector<Vec3d> eyes;
    for (const CameraView& view : imported.scene.cameras)
        eyes.push_back(view.position);
    return nearestPlace(imported, median(eyes));
}

/// Median distance of `samples` from `center`, the largest where that is 0.
double sizeAbout(const Vec3d& center, const std::vector<Vec3d>& samples)
{
    std::vector<double> distances;
    for (const Vec3d& p : samples)
        distances.push_back(length(p - center));
    const double farthest = *std::max_element(distances.begin(), distances.end());
    const double size = median(std::move(distances));
    return size > 0 ? size : farthest;
}

/// The origin of the object that is nearest to `center`, if there is one near: seen from there its coordinates are
/// those that the file stores, without any rounding. Else `center`, rounded.
Vec3d originNear(const Vec3d& center, double size, const ImportedScene& imported)
{
    const double step = std::ldexp(1.0, std::ilogb(largest(center)) - kOriginBits);
    const auto round = [step](double v) { return std::round(v / step) * step + 0.0; }; // + 0: no -0
    Vec3d origin{round(center.x), round(center.y), round(center.z)};
    double least = kNearObject * size;
    for (const ImportedInstance& instance : imported.instances)
    {
        const auto& [x, y, z] = instance.to_world.translation;
        const Vec3d place{x, y, z};
        if (const double distance = length(place - center); distance < least)
        {
            least = distance;
            origin = place;
        }
    }
    return origin;
}
} // namespace

WorldFrame chooseFrame(const ImportedScene& imported)
{
    WorldFrame frame;
    const std::vector<Vec3d> samples = sampleTriangles(imported);
    if (samples.empty())
        return frame;
    const Vec3d center = centerOf(imported, samples);
    const double size = sizeAbout(center, samples);
    if (!isFinite(center) || !std::isfinite(size) || size == 0)
        return frame;
    if (largest(center) > kFarthest * size)
        frame.origin = originNear(center, size, imported);
    if (size < std::ldexp(1.0, kSmallest) || size > std::ldexp(1.0, kLargest))
        frame.unit = std::ldexp(1.0, std::ilogb(size));
    return frame;
}

Status moveIntoFrame(ImportedScene& imported, const WorldFrame& frame)
{
    SceneData& scene = imported.scene;
    scene.frame = frame;
    const double scale = 1 / frame.unit;
    const auto moved = [&](const Vec3d& p) { return (p - frame.origin) * scale; };
    for (ImportedInstance& instance : imported.instances)
    {
        auto& [linear, translation] = instance.to_world;
        for (double& element : linear)
            element *= scale;
        const Vec3d place = moved({translation[0], translation[1], translation[2]});
        translation = {place.x, place.y, place.z};
    }
    const auto scaled = [](float value, double factor)
    { return float(std::min(value * factor, double(std::numeric_limits<float>::max()))); };
    for (CameraView& view : scene.cameras)
    {
        view.position = moved(view.position);
        for (float* distance : {&view.orthographic_height, &view.near_plane, &view.far_plane})
            *distance = scaled(*distance, scale);
        if (!isFinite(toFloat(view.position)))
            return Error{ExitCode::kInvalid, fmt::format("camera \"{}\" is beyond the range of numbers", view.name)};
    }
    for (PunctualLight& light : scene.lights)
    {
        light.position = moved(light.position);
        if (light.kind != gpu::kLightDirectional) // as bright at a distance that is now another number
            for (float* channel : {&light.intensity.x, &light.intensity.y, &light.intensity.z})
                *channel = float(*channel * scale * scale);
        if (!isFinite(toFloat(light.position)) || !isFinite(light.intensity))
            return Error{ExitCode::kInvalid, "a light is beyond the range of numbers"};
    }
    for (gpu::Material& material : scene.materials)
        for (float* channel : {&material.absorption.x, &material.absorption.y, &material.absorption.z})
            *channel = scaled(*channel, frame.unit);
    if (frame.unit != 1)
        scene.warnings.push_back(fmt::format("the scene's size is outside {:.1g} m to {:.1g} m: the package measures "
                                             "lengths in units of {:.4g} m",
                                             std::ldexp(1.0, kSmallest), std::ldexp(1.0, kLargest), frame.unit));
    return Success{};
}
