#include "compiler/light_need.h"

#include "compiler/environment.h"
#include "compiler/vector_math.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace
{
constexpr double kPi = std::numbers::pi;
// Albedo 0.5, and as much again by way of other surfaces, as in a closed room: 0.5 + 0.25 + ...
constexpr double kReflectance = 1;
// Radiance of grey that the player's default display transform (AgX, exposure 0) shows as 0.5 and 8 of 255.
constexpr double kDark = 0.00127;
constexpr double kDim = 0.00604;
constexpr uint32_t kColumns = 24, kRows = 14; // of a camera's picture, 16:9 or nearly
constexpr size_t kMostCameras = 8;
constexpr size_t kMostLights = 256; // evaluated at each point
constexpr size_t kMostSurfaces = 256;

struct Point
{
    Vec3d place;
    Vec3d normal; // unit, on the viewer's side
};

/// The triangle that a ray meets first, by its index in Bvh::triangles.
class Caster
{
public:
    explicit Caster(const Bvh& bvh) : bvh_(bvh) {}

    std::optional<Point> first(const Vec3d& from, const Vec3d& along) const
    {
        double nearest = std::numeric_limits<double>::infinity();
        const gpu::BvhTriangle* met = nullptr;
        std::vector<uint32_t> stack{0};
        while (!stack.empty())
        {
            const gpu::BvhNode& node = bvh_.nodes[stack.back()];
            stack.pop_back();
            for (uint32_t i = 0; i < gpu::kBvhWidth; ++i)
            {
                const uint32_t child = (&node.child.x)[i];
                if (child == gpu::kNone || !meets(node, i, from, along, nearest))
                    continue;
                if ((child & gpu::kLeafBit) == 0)
                {
                    stack.push_back(child);
                    continue;
                }
                const uint32_t count = (child >> gpu::kLeafCountShift & gpu::kLeafCountMask) + 1;
                for (uint32_t t = 0; t < count; ++t)
                {
                    const gpu::BvhTriangle& triangle = bvh_.triangles[(child & gpu::kLeafFirstMask) + t];
                    if (const double distance = hit(triangle, from, along); distance < nearest)
                    {
                        nearest = distance;
                        met = &triangle;
                    }
                }
            }
        }
        if (met == nullptr)
            return std::nullopt;
        Vec3d normal = unitOrZero(cross(toDouble(met->v1) - toDouble(met->v0), toDouble(met->v2) - toDouble(met->v0)));
        return Point{from + along * nearest, dot(normal, along) > 0 ? normal * -1 : normal};
    }

private:
    static bool meets(const gpu::BvhNode& node, uint32_t i, const Vec3d& from, const Vec3d& along, double nearest)
    {
        double enter = 0;
        double leave = nearest;
        const auto slab = [&](const gpu::vec4& low, const gpu::vec4& high, double origin, double direction)
        {
            const double a = ((&low.x)[i] - origin) / direction;
            const double b = ((&high.x)[i] - origin) / direction;
            enter = std::max(enter, std::fmin(a, b)); // fmin: 0 / 0 on a plane of the box is inside
            leave = std::min(leave, std::fmax(a, b));
        };
        slab(node.min_x, node.max_x, from.x, along.x);
        slab(node.min_y, node.max_y, from.y, along.y);
        slab(node.min_z, node.max_z, from.z, along.z);
        return enter <= leave * (1 + 1e-12);
    }

    /// Distance, or infinity. After Moeller and Trumbore.
    static double hit(const gpu::BvhTriangle& t, const Vec3d& from, const Vec3d& along)
    {
        const Vec3d a = toDouble(t.v1) - toDouble(t.v0);
        const Vec3d b = toDouble(t.v2) - toDouble(t.v0);
        const Vec3d p = cross(along, b);
        const double determinant = dot(a, p);
        const Vec3d offset = from - toDouble(t.v0);
        const Vec3d q = cross(offset, a);
        const double u = dot(offset, p) / determinant;
        const double v = dot(along, q) / determinant;
        const double distance = dot(b, q) / determinant;
        return u >= 0 && v >= 0 && u + v <= 1 && distance > 0 ? distance : std::numeric_limits<double>::infinity();
    }

    const Bvh& bvh_;
};

std::vector<Point> seenBy(const CameraView& view, const Caster& caster)
{
    const Vec3d forward = toDouble(view.forward);
    const Vec3d up = toDouble(view.up);
    const Vec3d right = cross(forward, up);
    const bool orthographic = view.vertical_fov == 0;
    const double half = orthographic ? view.orthographic_height / 2 : std::tan(view.vertical_fov / 2);
    std::vector<Point> points;
    for (uint32_t row = 0; row < kRows; ++row)
        for (uint32_t column = 0; column < kColumns; ++column)
        {
            const double x = (2 * column + 1.0 - kColumns) / kRows * half;
            const double y = (2 * row + 1.0 - kRows) / kRows * half;
            const Vec3d offset = right * x + up * y;
            const std::optional<Point> point = orthographic ? caster.first(view.position + offset, forward)
                                                            : caster.first(view.position, unitOrZero(forward + offset));
            if (point)
                points.push_back(*point);
        }
    return points;
}

/// Both sides of triangles all over the scene.
std::vector<Point> surfaces(const WorldMesh& mesh)
{
    std::vector<Point> points;
    const size_t stride = 1 + mesh.triangles.size() / kMostSurfaces;
    for (size_t i = 0; i < mesh.triangles.size(); i += stride)
    {
        const gpu::uvec3 t = mesh.triangles[i];
        const Vec3d a = toDouble(mesh.positions[t.x]), b = toDouble(mesh.positions[t.y]),
                    c = toDouble(mesh.positions[t.z]);
        const Vec3d normal = unitOrZero(cross(b - a, c - a));
        points.push_back({(a + b + c) * (1.0 / 3), normal});
        points.push_back({(a + b + c) * (1.0 / 3), normal * -1});
    }
    return points;
}

double areaOf(const gpu::vec3& a, const gpu::vec3& b, const gpu::vec3& c)
{
    return length(cross(toDouble(b) - toDouble(a), toDouble(c) - toDouble(a))) / 2;
}

bool isTriangle(const gpu::Light& light)
{
    return light.kind == gpu::kLightTriangle || light.kind == gpu::kLightTriangleTwoSided;
}

/// Ray number `i` of an emissive triangle: from an even place on it, by the cosine (the sequence of Roberts 2018).
/// @return whether it meets a surface
bool meetsSurface(const gpu::Light& light, uint32_t i, const Caster& caster)
{
    const auto fraction = [&](double step) { return std::fmod(i * step + 0.5, 1.0); };
    const Vec3d u = toDouble(light.p1) - toDouble(light.p0), v = toDouble(light.p2) - toDouble(light.p0);
    const Vec3d front = unitOrZero(cross(u, v)), side = unitOrZero(u), up = cross(front, side);
    const double x = fraction(0.8566748838), y = fraction(0.7338918566), r = std::sqrt(fraction(0.6287067210));
    const double phi = 2 * kPi * fraction(0.5385972572), first = std::min(x, y), second = std::max(x, y) - first;
    const double facing = light.kind == gpu::kLightTriangleTwoSided && i % 2 == 1 ? -1 : 1;
    const Vec3d from = toDouble(light.p0) + u * first + v * second + front * (facing * 1e-4 * (length(u) + length(v)));
    const Vec3d way = side * (r * std::cos(phi)) + up * (r * std::sin(phi)) + front * (facing * std::sqrt(1 - r * r));
    return bool(caster.first(from, unitOrZero(way)));
}

/// Share of the power of emissive triangles that meets a surface again: in the open most of it is lost. By rays, evenly spaced over
/// the power; 1 where no triangle emits.
double keptShare(const LightTables& lights, const Caster& caster)
{
    constexpr uint32_t kRays = 1024;
    double total = 0;
    for (size_t i = 0; i < lights.lights.size(); ++i)
        total += isTriangle(lights.lights[i]) ? lights.powers[i] : 0;
    uint32_t rays = 0, kept = 0;
    double sum = 0;
    for (size_t i = 0; i < lights.lights.size() && total > 0; ++i)
    {
        if (!isTriangle(lights.lights[i]))
            continue;
        for (sum += lights.powers[i]; (rays + 0.5) / kRays < sum / total && rays < kRays; ++rays)
            kept += meetsSurface(lights.lights[i], rays, caster) ? 1 : 0;
    }
    return rays == 0 ? 1 : double(kept) / rays;
}

/// Irradiance, were the power of all local lights spread over a sphere about them and the scene.
double spreadPower(const WorldMesh& mesh, const LightTables& lights)
{
    gpu::vec3 low = mesh.positions[0];
    gpu::vec3 high = low;
    const auto grow = [&](const gpu::vec3& p) { low = min(low, p), high = max(high, p); };
    for (const gpu::vec3& p : mesh.positions)
        grow(p);
    double power = 0;
    for (size_t i = 0; i < lights.lights.size(); ++i)
        if (const gpu::Light& light = lights.lights[i];
            light.kind != gpu::kLightDirectional && light.kind != gpu::kLightEnvironment)
        {
            power += lights.powers[i];
            grow(light.p0);
        }
    const Vec3d diagonal = toDouble(high) - toDouble(low);
    return power / (4 * kPi * std::max(dot(diagonal, diagonal), 1e-30));
}

/// Unoccluded irradiance at `point` by light `i`. Local lights count as if they and the point faced each other: a scene with
/// a narrow spot, or a lamp that lights from behind, is lit on purpose and gets no default light.
double irradiance(const LightTables& lights, size_t i, const Point& point, double environment)
{
    const gpu::Light& light = lights.lights[i];
    if (light.kind == gpu::kLightEnvironment)
        return kPi * environment;
    if (light.kind == gpu::kLightDirectional)
        return luminance(light.emission);
    const bool local = light.kind == gpu::kLightPoint || light.kind == gpu::kLightSpot;
    const Vec3d place =
        local ? toDouble(light.p0) : (toDouble(light.p0) + toDouble(light.p1) + toDouble(light.p2)) * (1.0 / 3);
    const double squared = dot(place - point.place, place - point.place);
    const Vec3d towards = unitOrZero(place - point.place);
    const double facing = std::max(0.0, dot(point.normal, towards));
    if (local)
        return luminance(light.emission) / std::max(squared, 1e-30);
    const bool both = light.kind == gpu::kLightTriangleTwoSided;
    const double exitance = lights.powers[i] / (areaOf(light.p0, light.p1, light.p2) * (both ? 2 : 1));
    const Vec3d front = unitOrZero(cross(toDouble(light.p1 - light.p0), toDouble(light.p2 - light.p0)));
    const double cosine = both ? std::abs(dot(front, towards)) : std::max(0.0, -dot(front, towards));
    const double form_factor = areaOf(light.p0, light.p1, light.p2) * cosine / (kPi * std::max(squared, 1e-30));
    return exitance * std::min(form_factor, 1.0) * facing; // no more than if it filled the view
}

/// All lights, or some of many with the weight that each then has.
std::vector<std::pair<size_t, double>> askedLights(const LightTables& lights)
{
    std::vector<std::pair<size_t, double>> asked;
    if (lights.lights.size() <= kMostLights)
    {
        for (size_t i = 0; i < lights.lights.size(); ++i)
            asked.emplace_back(i, 1);
        return asked;
    }
    double total = 0;
    for (const float power : lights.powers)
        total += power;
    double sum = 0;
    for (size_t i = 0; i < lights.lights.size(); ++i) // evenly spaced over the power
    {
        sum += lights.powers[i];
        size_t times = 0;
        for (; double(asked.size()) + 0.5 < sum / total * kMostLights && asked.size() < kMostLights; ++times)
            asked.emplace_back(i, total / (kMostLights * double(lights.powers[i])));
    }
    return asked;
}

/// The lower bound of what the brightest quarter of `points` reflects.
double bestQuarter(const std::vector<Point>& points, const LightTables& lights, double environment, double everywhere)
{
    const auto asked = askedLights(lights);
    std::vector<double> radiance;
    for (const Point& point : points)
    {
        double sum = everywhere;
        for (const auto& [light, weight] : asked)
            sum += weight * irradiance(lights, light, point, environment);
        radiance.push_back(kReflectance / kPi * sum);
    }
    const auto quarter = radiance.begin() + ptrdiff_t(radiance.size() / 4);
    std::nth_element(radiance.begin(), quarter, radiance.end(), std::greater<>());
    return *quarter;
}

/// "its only light is ...": the strongest.
std::string describe(const SceneData& scene, const LightTables& lights)
{
    const size_t strongest =
        size_t(std::max_element(lights.powers.begin(), lights.powers.end()) - lights.powers.begin());
    const gpu::Light& light = lights.lights[strongest];
    const std::string source =
        light.triangle != gpu::kNone
            ? fmt::format("material \"{}\"", scene.material_names[scene.mesh.materials[light.triangle]])
        : light.kind == gpu::kLightEnvironment ? "the environment"
                                               : "a lamp";
    return lights.lights.size() == 1 || light.triangle != gpu::kNone ? source : source + " and others";
}
} // namespace

LightNeed judgeLight(const SceneData& scene, const Bvh& bvh, const LightTables& lights)
{
    LightNeed need;
    if (lights.lights.empty())
    {
        need.dark = true;
        need.sentence = "the scene has no light at all";
        return need;
    }
    const double environment = scene.environment ? luminance(averageRadiance(*scene.environment)) : 0;
    const Caster caster(bvh);
    const double everywhere = spreadPower(scene.mesh, lights) * keptShare(lights, caster);
    bool seen = false;
    for (size_t c = 0; c < std::min(scene.cameras.size(), kMostCameras); ++c)
        if (const std::vector<Point> points = seenBy(scene.cameras[c], caster); !points.empty())
        {
            need.radiance = std::max(need.radiance, bestQuarter(points, lights, environment, everywhere));
            seen = true;
        }
    if (!seen)
        need.radiance = bestQuarter(surfaces(scene.mesh), lights, environment, everywhere);
    need.dark = need.radiance < kDark;
    need.dim = need.radiance < kDim;
    if (need.dim)
        need.sentence =
            fmt::format("the scene's light ({}) reaches little of what is seen: but for a quarter, surfaces reflect "
                        "less than {:.2g} W/(m^2 sr), and pictures show nothing below {:.2g}",
                        describe(scene, lights), need.radiance, kDark);
    return need;
}
