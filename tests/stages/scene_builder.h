// Tiny scenes whose light is known in closed form, as glTF and compiled to a package by the compiler itself.
#pragma once
#include "format/gpu_types.h"
#include "image/image.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <vector>

class SceneBuilder
{
public:
    SceneBuilder();
    ~SceneBuilder();
    SceneBuilder(const SceneBuilder&) = delete;
    SceneBuilder& operator=(const SceneBuilder&) = delete;

    /// A glTF material as it stands in the file. @return its index
    int material(const nlohmann::json& material);
    /// A glTF texture of RGBA bytes (sRGB colour), repeated and bilinearly filtered. @return its index
    int texture(uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba);

    /// A parallelogram of two triangles in world space; its front is where cross(edge_u, edge_v) points.
    /// TEXCOORD_0 runs from 0 to 1 along both edges.
    void quad(gpu::vec3 corner, gpu::vec3 edge_u, gpu::vec3 edge_v, int material);
    /// The same with another shading normal than its own.
    void quad(gpu::vec3 corner, gpu::vec3 edge_u, gpu::vec3 edge_v, int material, gpu::vec3 normal);
    /// A horizontal square of `side` metres about (0, height, 0), facing up.
    void floor(float side, float height, int material);
    /// An axis-parallel box, faces outwards or inwards.
    void box(gpu::vec3 low, gpu::vec3 high, int material, bool inwards = false);
    /// A sphere of 2 n^2 quads (as triangles); `smooth`: with the true sphere's normals, else one normal a facet. A negative
    /// radius turns its front inwards.
    void sphere(gpu::vec3 center, float radius, int n, bool smooth, int material);

    /// A light of KHR_lights_punctual on a node with these properties, below a node with those of `parent`.
    void light(const nlohmann::json& light, const nlohmann::json& node,
               const nlohmann::json& parent = nlohmann::json::object());
    /// An equirectangular map around everything, turned by `rotation` radians about +Y.
    void environment(const ImageF& map, float rotation = 0);

    /// Writes and compiles it; without any light it stays dark. Aborts where the compiler refuses it.
    /// @return the package, which lives as long as the builder
    std::filesystem::path compile();

private:
    void mesh(const std::vector<gpu::vec3>& positions, const std::vector<gpu::vec3>& normals,
              const std::vector<float>& uv, int material);
    void noteExtensions(const nlohmann::json& object);
    struct State;
    std::unique_ptr<State> state_;
};

/// A perfectly diffuse material: KHR_materials_specular takes the dielectric layer away.
nlohmann::json lambert(double albedo);
/// Black, and gives `radiance` W/(m^2 sr).
nlohmann::json emitter(double radiance);
/// `material` with `patch` merged in (RFC 7396).
nlohmann::json with(nlohmann::json material, const nlohmann::json& patch);
