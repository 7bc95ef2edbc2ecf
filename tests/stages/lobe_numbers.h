// What a rough reflection lobe does, in numbers: for the judges of its table and of the pictures made with it.
#pragma once
#include "runtime/stages/glossy_lobe.h"
#include "tests/stages/gltf_brdf.h"

#include <algorithm>
#include <array>
#include <cmath>

/// Directional albedo of the reflection lobe of ior 1.5 by the judge's quadrature.
inline double specularAlbedo(double roughness, double cosine)
{
    return directionalAlbedo({.base_color = {0, 0, 0}, .roughness = roughness}, cosine)[0];
}

inline constexpr double kNormalReflectance = 0.04; // of ior 1.5
inline double reflectanceOf(const gpu::GlossyLobe& lobe)
{
    return kNormalReflectance * lobe.scale + lobe.bias;
}

inline double tableRoughness(uint32_t r)
{
    return gpu::kHarmonicsFrom + (1.0 - gpu::kHarmonicsFrom) * r / (gpu::kLobeRoughnesses - 1);
}
inline double tableCosine(uint32_t c)
{
    return double(c) / (gpu::kLobeCosines - 1);
}

/// Coefficients of bands 0 to 3 of the zonal function.
inline std::array<double, 4> zonalOf(const gpu::GlossyLobe& lobe)
{
    const double a = lobe.concentration;
    return {1, 3 * a, 5 * std::pow(a, 3), 7 * std::pow(a, 6)};
}

/// What even light of radiance 1 makes of it, over that of a constant function.
inline double evenAnswer(const gpu::GlossyLobe& lobe)
{
    const double mu = lobe.height;
    return std::max(0.05, 1 + zonalOf(lobe)[1] * 2 / 3 * mu + zonalOf(lobe)[2] / 4 * (1.5 * mu * mu - 0.5));
}
