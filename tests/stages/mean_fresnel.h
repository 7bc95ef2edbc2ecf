// glTF's dielectric BRDF, and the one by which Cycles' reference pictures stand in for it. Cycles' nodes have no access to the
// half vector: instead of F(V.H) its surfaces take F's mean over all light directions, a function of N.V. The
// directional albedo is the same; what one small light contributes is not.
#pragma once
#include "format/package_read.h"
#include "shaders/rays/rays.h"

#include <optional>
#include <vector>

/// The light of one punctual light, without shadow, at the surface that a ray has met.
struct DirectLight
{
    gpu::Ray shadow_ray;    // its path: the caller's
    gpu::vec3 gltf;         // reflected towards the ray's origin, W/(m^2 sr)
    gpu::vec3 mean_fresnel; // the same by the stand-in
};

/// For opaque dielectrics of one roughness, without maps but for the base colour, under point and directional lights.
class DirectLightByBothModels
{
public:
    explicit DirectLightByBothModels(const package::Package& package);

    /// @return nothing where the light is behind the surface
    std::optional<DirectLight> operator()(const gpu::Ray& ray, const gpu::Hit& hit, const gpu::Light& light) const;

private:
    double meanRise(const std::vector<double>& table, double n_v) const;
    std::array<double, 3> baseColor(const gpu::Material& material, const gpu::Hit& hit) const;

    const package::Package& package_;
    double alpha_;                           // GGX width
    std::vector<double> diffuse_, specular_; // mean of (1 - V.H)^5, by N.V from 0 to 1
};
