// The glTF 2.0 BRDF (specification, appendix B) in double precision, written down apart from the shaders as their
// judge.
#pragma once
#include <array>

struct GltfMaterial
{
    std::array<double, 3> base_color{1, 1, 1};
    double metallic = 0;
    double roughness = 1;
    double ior = 1.5;    // KHR_materials_ior
    double specular = 1; // KHR_materials_specular
    std::array<double, 3> specular_color{1, 1, 1};
};

/// Radiance towards `v` per irradiance from `l`, 1/sr; both unit and local, z along the normal. Roughness 0 leaves out
/// the mirror image, which has no finite value.
std::array<double, 3> gltfBrdf(const GltfMaterial& material, const std::array<double, 3>& v,
                               const std::array<double, 3>& l);

/// Share of a uniform white sky that is reflected towards a viewer at `cosine` from the normal.
std::array<double, 3> directionalAlbedo(const GltfMaterial& material, double cosine);
