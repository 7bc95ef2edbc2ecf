#include "tests/stages/gltf_brdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace
{
constexpr double kPi = std::numbers::pi;
using Vector = std::array<double, 3>;
using Rgb = std::array<double, 3>;

double dot(const Vector& a, const Vector& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector halfway(const Vector& a, const Vector& b)
{
    Vector h{a[0] + b[0], a[1] + b[1], a[2] + b[2]};
    const double length = std::sqrt(dot(h, h));
    for (double& component : h)
        component /= length;
    return h;
}

/// Weights of the two things a material is made of at one angle: light sent back at once, and Lambert's below.
struct Layers
{
    Rgb specular, diffuse;
};

Layers layersAt(const GltfMaterial& m, double v_dot_h)
{
    const double rise = std::pow(1 - std::abs(v_dot_h), 5);
    const double normal = (m.ior - 1) * (m.ior - 1) / ((m.ior + 1) * (m.ior + 1));
    Rgb dielectric{}, metal{};
    for (size_t c = 0; c < 3; ++c)
    {
        const double f0 = std::min(normal * m.specular_color[c], 1.0) * m.specular;
        dielectric[c] = f0 + (m.specular - f0) * rise;
        metal[c] = m.base_color[c] + (1 - m.base_color[c]) * rise;
    }
    const double largest = std::max({dielectric[0], dielectric[1], dielectric[2]});
    Layers layers;
    for (size_t c = 0; c < 3; ++c)
    {
        layers.specular[c] = (1 - m.metallic) * dielectric[c] + m.metallic * metal[c];
        layers.diffuse[c] = (1 - m.metallic) * (1 - largest) * m.base_color[c];
    }
    return layers;
}

/// One factor of the separable Smith shadowing-masking function.
double smith(double cosine, double alpha)
{
    return 2 * cosine / (cosine + std::sqrt(alpha * alpha + (1 - alpha * alpha) * cosine * cosine));
}
} // namespace

Rgb gltfBrdf(const GltfMaterial& material, const Vector& v, const Vector& l)
{
    const Vector h = halfway(v, l);
    const Layers layers = layersAt(material, dot(v, h));
    double lobe = 0;
    if (const double alpha = material.roughness * material.roughness; alpha > 0)
    {
        const double root = h[2] * h[2] * (alpha * alpha - 1) + 1;
        const double distribution = alpha * alpha / (kPi * root * root);
        lobe = distribution * smith(v[2], alpha) * smith(l[2], alpha) / (4 * v[2] * l[2]);
    }
    Rgb f{};
    for (size_t c = 0; c < 3; ++c)
        f[c] = layers.specular[c] * lobe + layers.diffuse[c] / kPi;
    return f;
}

Rgb directionalAlbedo(const GltfMaterial& material, double cosine)
{
    constexpr int kSteps = 1024; // midpoint rule in both dimensions
    const Vector v{std::sqrt(1 - cosine * cosine), 0, cosine};
    const double alpha = material.roughness * material.roughness;
    Rgb sum{};
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k)
        {
            const double u = (i + 0.5) / kSteps, phi = kPi * (k + 0.5) / kSteps; // the other half is its mirror image
            // Diffuse part: light directions, equal steps of projected solid angle.
            const double r = std::sqrt(u);
            const Vector l{r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)};
            const Layers below = layersAt(material, dot(v, halfway(v, l)));
            for (size_t c = 0; c < 3; ++c)
                sum[c] += below.diffuse[c];
            if (alpha == 0)
                continue;
            // Specular part: microfacet normals, equal steps of D cos. What remains of the integrand is F G V.H/(N.V
            // N.H).
            const double tangent2 = alpha * alpha * u / (1 - u);
            const double h_z = 1 / std::sqrt(1 + tangent2), h_r = std::sqrt(1 - h_z * h_z);
            const Vector h{h_r * std::cos(phi), h_r * std::sin(phi), h_z};
            const double v_dot_h = dot(v, h), l_z = 2 * v_dot_h * h_z - v[2];
            if (v_dot_h <= 0 || l_z <= 0)
                continue;
            const Layers layers = layersAt(material, v_dot_h);
            const double rest = smith(v[2], alpha) * smith(l_z, alpha) * v_dot_h / (v[2] * h_z);
            for (size_t c = 0; c < 3; ++c)
                sum[c] += layers.specular[c] * rest;
        }
    const Layers mirror = layersAt(material, cosine);
    Rgb albedo{};
    for (size_t c = 0; c < 3; ++c)
        albedo[c] = sum[c] / (double(kSteps) * kSteps) + (alpha == 0 ? mirror.specular[c] : 0);
    return albedo;
}
