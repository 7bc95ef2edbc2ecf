#include "tests/stages/mean_fresnel.h"

#include "compiler/encode.h"
#include "format/check.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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
Vec operator*(double s, Vec a)
{
    return {s * a.x, s * a.y, s * a.z};
}
double dot(Vec a, Vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vec crossed(Vec a, Vec b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vec unit(Vec a)
{
    return 1 / std::sqrt(dot(a, a)) * a;
}
Vec exact(gpu::vec3 v)
{
    return {v.x, v.y, v.z};
}
gpu::vec3 rounded(Vec v)
{
    return {float(v.x), float(v.y), float(v.z)};
}

constexpr double kPi = std::numbers::pi;
constexpr double kF0 = 0.04; // index 1.5
double rise(double v_h)
{
    return std::pow(1 - std::clamp(v_h, 0.0, 1.0), 5);
}

/// glTF 2.0, appendix B: D G / (4 N.L N.V), separable Smith masking.
double ggxLobe(double n_l, double n_v, double n_h, double alpha)
{
    const double a2 = alpha * alpha, d = n_h * n_h * (a2 - 1) + 1;
    const auto g1 = [&](double c) { return 2 * c / (c + std::sqrt(a2 + (1 - a2) * c * c)); };
    return a2 / (kPi * d * d) * g1(n_l) * g1(n_v) / (4 * n_l * n_v);
}

/// Mean of (1 - V.H)^5 over L, weighted with `lobe` x N.L, by the midpoint rule.
template <typename Lobe>
double meanRiseAt(double n_v, const Lobe& lobe)
{
    constexpr int kSteps = 200;
    const Vec v{std::sqrt(1 - n_v * n_v), 0, n_v};
    double sum = 0, weights = 0;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k)
        {
            const double n_l = (i + 0.5) / kSteps, phi = kPi * (k + 0.5) / kSteps; // symmetric in phi
            const double s = std::sqrt(1 - n_l * n_l);
            const Vec l{s * std::cos(phi), s * std::sin(phi), n_l}, h = unit(l + v);
            const double weight = n_l * lobe(n_l, h.z);
            sum += weight * rise(dot(v, h));
            weights += weight;
        }
    return sum / weights;
}

constexpr int kTableSize = 64;
constexpr double kLeastCosine = 2e-3;
} // namespace

DirectLightByBothModels::DirectLightByBothModels(const package::Package& package) : package_(package)
{
    const gpu::Material& first = package.materials()[0];
    for (const gpu::Material& m : package.materials())
        check(m.roughness == first.roughness && m.metallic == 0 && m.metallic_roughness_texture == gpu::kNone &&
                  m.ior == 1.5f && m.specular == 1 && m.normal_texture == gpu::kNone,
              "this comparison is for plain dielectrics of one roughness");
    alpha_ = double(first.roughness) * first.roughness;
    for (int i = 0; i <= kTableSize; ++i)
    {
        const double n_v = std::max(double(i) / kTableSize, kLeastCosine);
        diffuse_.push_back(meanRiseAt(n_v, [](double, double) { return 1.0; }));
        specular_.push_back(meanRiseAt(n_v, [&](double n_l, double n_h) { return ggxLobe(n_l, n_v, n_h, alpha_); }));
    }
}

double DirectLightByBothModels::meanRise(const std::vector<double>& table, double n_v) const
{
    const double at = n_v * kTableSize;
    const size_t i = std::min(size_t(at), size_t(kTableSize - 1));
    return table[i] + (at - double(i)) * (table[i + 1] - table[i]);
}

/// The base colour texture bilinearly filtered, repeated, sRGB; no transform.
std::array<double, 3> DirectLightByBothModels::baseColor(const gpu::Material& material, const gpu::Hit& hit) const
{
    std::array<double, 3> color{material.base_color.x, material.base_color.y, material.base_color.z};
    if (material.base_color_texture == gpu::kNone)
        return color;
    const gpu::TextureRef& ref = package_.textureRefs()[material.base_color_texture];
    const auto& page = *(*package_.meta().texture_pages())[ref.page];
    const auto texels = package_.texturePage(ref.page);
    const gpu::uvec3 v = package_.triangles()[package_.bvhTriangles()[hit.slot].triangle].vertices;
    const auto vertices = package_.vertexAttributes();
    const double w1 = hit.barycentrics.x, w2 = hit.barycentrics.y, w0 = 1 - w1 - w2;
    const int width = int(page.width()), height = int(page.height());
    const double x = (w0 * vertices[v.x].uv0.x + w1 * vertices[v.y].uv0.x + w2 * vertices[v.z].uv0.x) * width - 0.5;
    const double y = (w0 * vertices[v.x].uv0.y + w1 * vertices[v.y].uv0.y + w2 * vertices[v.z].uv0.y) * height - 0.5;
    const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
    const auto linear = [&](int column, int row, size_t channel)
    {
        const size_t texel = (size_t(ref.layer) * height + size_t((row % height + height) % height)) * width +
                             size_t((column % width + width) % width);
        const double c = double(uint8_t(texels[4 * texel + channel])) / 255;
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    };
    for (size_t k = 0; k < 3; ++k)
    {
        const double fx = x - x0, fy = y - y0;
        color[k] *= (1 - fy) * ((1 - fx) * linear(x0, y0, k) + fx * linear(x0 + 1, y0, k)) +
                    fy * ((1 - fx) * linear(x0, y0 + 1, k) + fx * linear(x0 + 1, y0 + 1, k));
    }
    return color;
}

std::optional<DirectLight> DirectLightByBothModels::operator()(const gpu::Ray& ray, const gpu::Hit& hit,
                                                               const gpu::Light& light) const
{
    check(light.kind == gpu::kLightPoint || light.kind == gpu::kLightDirectional, "a light of kind {}", light.kind);
    const gpu::BvhTriangle& t = package_.bvhTriangles()[hit.slot];
    const Vec a = exact(t.v0), b = exact(t.v1), c = exact(t.v2), along = exact(ray.direction);
    const double w1 = hit.barycentrics.x, w2 = hit.barycentrics.y, w0 = 1 - w1 - w2;
    const Vec point = w0 * a + w1 * b + w2 * c;
    Vec geometric = unit(crossed(b - a, c - a));
    const gpu::uvec3 v = package_.triangles()[t.triangle].vertices;
    const auto normalOf = [&](uint32_t vertex)
    { return exact(decodeNormal(package_.vertexAttributes()[vertex].normal)); };
    Vec normal = unit(w0 * normalOf(v.x) + w1 * normalOf(v.y) + w2 * normalOf(v.z));
    if (dot(geometric, along) > 0)
    {
        geometric = -1 * geometric;
        normal = -1 * normal;
    }
    const bool directional = light.kind == gpu::kLightDirectional;
    const Vec to_light = directional ? -1 * exact(light.p1) : exact(light.p0) - point;
    const double distance = directional ? 1e30 : std::sqrt(dot(to_light, to_light));
    const Vec l = unit(to_light), view = -1 * along, h = unit(l + view);
    const double n_l = dot(normal, l), n_v = std::max(dot(normal, view), kLeastCosine);
    if (n_l <= 0 || dot(geometric, l) <= 0)
        return std::nullopt;

    const double lobe = ggxLobe(n_l, n_v, dot(normal, h), alpha_);
    const auto fresnel = [](double mean_rise) { return kF0 + (1 - kF0) * mean_rise; };
    const double f = fresnel(rise(dot(view, h)));
    const double f_diffuse = fresnel(meanRise(diffuse_, n_v)), f_specular = fresnel(meanRise(specular_, n_v));
    const std::array<double, 3> base = baseColor(package_.materials()[t.material], hit);
    const Vec irradiance = n_l / (directional ? 1 : distance * distance) * exact(light.emission);
    const auto reflected = [&](double of_diffuse, double of_specular)
    {
        return rounded({irradiance.x * ((1 - of_diffuse) * base[0] / kPi + of_specular * lobe),
                        irradiance.y * ((1 - of_diffuse) * base[1] / kPi + of_specular * lobe),
                        irradiance.z * ((1 - of_diffuse) * base[2] / kPi + of_specular * lobe)});
    };
    constexpr double kOffTheSurface = 1e-4; // metres
    return DirectLight{.shadow_ray = {.origin = rounded(point + kOffTheSurface * geometric),
                                      .t_max = float(directional ? distance : distance * (1 - 1e-4)),
                                      .direction = rounded(l),
                                      .path = 0},
                       .gltf = reflected(f, f),
                       .mean_fresnel = reflected(f_diffuse, f_specular)};
}
