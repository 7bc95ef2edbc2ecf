#include "tests/stages/brute_force.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace
{
struct Vec
{
    double x, y, z;
};
Vec operator+(Vec a, Vec b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Vec operator-(Vec a, Vec b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
double dot(Vec a, Vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vec cross(Vec a, Vec b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(Vec a)
{
    return std::sqrt(dot(a, a));
}
Vec exact(gpu::vec3 v)
{
    return {v.x, v.y, v.z};
}

constexpr double kUlp = 0x1p-24;              // relative error of one rounding
constexpr double kRoot3 = 1.7320508075688772; // a bound on components bounds the length
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// The kernels form corners relative to the origin (error kUlp reach each), edges as their differences (3 kUlp reach),
/// three edge functions (corner + corner) x edge . direction, and t = normal . corner / normal . direction. The bounds
/// below follow these operations, first order in kUlp.
struct Errors
{
    double edge_function, numerator, denominator;

    Errors(double reach, double edge, double normal)
    {
        const double in_edge = 3 * reach, in_sum = 4 * reach;
        edge_function =
            kUlp * (kRoot3 * (2 * reach * in_edge + edge * in_sum + 3 * 2 * reach * edge) + 3 * 2 * reach * edge);
        const double in_normal = kRoot3 * (2 * edge * in_edge + 3 * edge * edge);
        numerator = kUlp * (in_normal * reach + 4 * normal * reach);
        denominator = kUlp * (in_normal + 3 * normal);
    }
};

/// Whether shadow rays may take the ray's end for a point of the plane: by twice planeError() of the kernels.
bool mayEndOn(const gpu::Ray& ray, const gpu::BvhTriangle& triangle, Vec normal)
{
    if (ray.t_max > 1e30f)
        return false;
    const Vec a = exact(triangle.v0), b = exact(triangle.v1), c = exact(triangle.v2), u = b - a, v = c - a;
    const Vec origin = exact(ray.origin), direction = exact(ray.direction);
    const auto product = [](double ui, double uk, double vi, double vk)
    { return std::abs(ui * vk) + std::abs(uk * vi); };
    const auto largest = [&](double Vec::*axis)
    {
        return std::max({std::abs(a.*axis), std::abs(b.*axis), std::abs(c.*axis)}) + std::abs(origin.*axis) +
               ray.t_max * std::abs(direction.*axis);
    };
    const Vec products{product(u.y, u.z, v.y, v.z), product(u.z, u.x, v.z, v.x), product(u.x, u.y, v.x, v.y)};
    const Vec reach{largest(&Vec::x), largest(&Vec::y), largest(&Vec::z)};
    const double error =
        8 * kUlp * std::min(dot(products, reach) / length(normal), 64 * std::max({reach.x, reach.y, reach.z}));
    const double off = dot(normal, a - origin) - ray.t_max * dot(normal, direction);
    return std::abs(off) <= 2 * error * length(normal);
}

std::optional<Meeting> meet(const gpu::Ray& ray, const gpu::BvhTriangle& triangle, uint32_t slot)
{
    const Vec origin = exact(ray.origin), direction = exact(ray.direction);
    const Vec a = exact(triangle.v0) - origin, b = exact(triangle.v1) - origin, c = exact(triangle.v2) - origin;
    const Vec normal = cross(b - a, c - a);
    const double reach = std::max({length(a), length(b), length(c)});
    const double edge = std::max({length(b - a), length(c - b), length(a - c)});
    const Errors error(reach, edge, length(normal));

    const double u = dot(cross(c + a, c - a), direction), v = dot(cross(a + b, a - b), direction),
                 w = dot(cross(b + c, b - c), direction);
    const double sign = u + v + w < 0 ? -1 : 1, sum = sign * (u + v + w);
    const double least = std::min({sign * u, sign * v, sign * w});
    if (least < -error.edge_function)
        return std::nullopt;

    const double along = dot(normal, direction);
    Meeting m{.slot = slot,
              .t = dot(normal, a) / along,
              .t_error = kInfinite,
              .u = 0,
              .v = 0,
              .weight_error = kInfinite,
              .certain = false,
              .ends_on_it = mayEndOn(ray, triangle, normal)};
    if (std::abs(along) < 2 * error.denominator || sum < 6 * error.edge_function)
        return m; // nothing is sure of a triangle seen edge-on
    m.t_error = 2 * (error.numerator + std::abs(m.t) * error.denominator) / std::abs(along) + 3 * kUlp * std::abs(m.t);
    m.u = sign * u / sum;
    m.v = sign * v / sum;
    m.weight_error = 2 * (1 + 3) * error.edge_function / sum + 3 * kUlp;
    if (m.t < -m.t_error || m.t > ray.t_max + m.t_error)
        return std::nullopt;
    m.certain = least > error.edge_function && m.t > m.t_error && m.t < ray.t_max - m.t_error;
    return m;
}
} // namespace

std::vector<Meeting> meetings(const gpu::Ray& ray, std::span<const gpu::BvhTriangle> triangles)
{
    std::vector<Meeting> found;
    for (uint32_t slot = 0; slot < triangles.size(); ++slot)
        if (const auto m = meet(ray, triangles[slot], slot))
            found.push_back(*m);
    return found;
}
