// Builds a binary glTF 2.0 file in memory.
#pragma once
#include "tools/scenes/shapes.h"
#include "tools/scenes/textures.h"

#include <nlohmann/json.hpp>

#include <array>
#include <optional>
#include <string>

/// glTF metallic-roughness and extensions; what is left at its default is not written.
struct MaterialDescription
{
    std::string name;
    Vec3 base_color{1, 1, 1}; // linear
    float metallic = 0;
    float roughness = 1;
    bool lambert = false; // KHR_materials_specular with factor and colour 0: no dielectric coat
    bool double_sided = false;
    std::optional<float> alpha_cutoff; // alphaMode MASK
    Vec3 emission{};                   // W/(m^2 sr)
    float transmission = 0;
    float ior = 1.5f;
    float thickness = 0; // metres; above 0: a refracting body, else thin-walled
    std::optional<Vec3> attenuation_color;
    float attenuation_distance = 0; // metres
    std::optional<uint32_t> base_color_texture, normal_texture, metallic_roughness_texture;
    float normal_scale = 1;
    nlohmann::ordered_json extensions; // others, by name
};

class GltfWriter
{
public:
    GltfWriter();

    uint32_t addTexture(const std::string& name, const Texture& texture);
    uint32_t addMaterial(const MaterialDescription& material);
    uint32_t addMesh(const std::string& name, const Mesh& mesh, uint32_t material);
    /// @return the node's index
    uint32_t addNode(const std::string& name, uint32_t mesh, Vec3 translation = {}, float turn_about_y = 0);
    /// A mesh used once.
    void add(const std::string& name, const Mesh& mesh, uint32_t material)
    {
        addNode(name, addMesh(name, mesh, material));
    }
    void addCamera(const std::string& name, Vec3 eye, Vec3 target, float vertical_fov); // radians
    void addSun(const std::string& name, Vec3 travels, Vec3 color, float irradiance);   // W/m^2 facing it
    void addPoint(const std::string& name, Vec3 position, Vec3 color, float intensity); // W/sr
    /// Full intensity (W/sr) up to `inner` radians off the direction `shines`, none from `outer` on.
    void addSpot(const std::string& name, Vec3 position, Vec3 shines, Vec3 color, float intensity, float inner,
                 float outer);
    /// Hangs all nodes so far under a new one that scales and then shifts them, in doubles; clip planes of cameras with
    /// them.
    void place(const std::string& name, const std::array<double, 3>& translation, double scale);

    /// Hangs the last `count` roots under a new one. @return its index
    uint32_t group(const std::string& name, size_t count, Vec3 translation = {});
    /// Joints are nodes below each other where `parent` says so, relative to these; -1: the root of them.
    struct Joint
    {
        std::string name;
        int parent = -1;
        Vec3 translation{}; // relative to the parent
    };
    /// A mesh that joints place: each vertex follows the one joint, or two, that `weights` gives it; the mesh is in the space
    /// of the first joint's parent, as bound. @return the joints' nodes
    std::vector<uint32_t> addSkinned(const std::string& name, const Mesh& mesh, uint32_t material,
                                     const std::vector<Joint>& joints, const std::vector<std::array<float, 4>>& weights,
                                     const std::vector<std::array<uint16_t, 4>>& joints_of_vertex);
    /// One channel of the only animation, linear. @param path translation, rotation or scale; values as it needs
    void animate(uint32_t node, const char* path, const std::vector<float>& times, const std::vector<float>& values);

    uint64_t triangleCount() const { return triangle_count_; } // as placed by nodes
    std::vector<uint8_t> glb() const;

private:
    uint32_t addView(const void* data, size_t bytes, int target);
    uint32_t addAccessor(const void* data, size_t count, size_t components, int component_type, int target);
    nlohmann::ordered_json& primitive(uint32_t mesh) { return json_["meshes"][mesh]["primitives"][0]; }
    void useExtension(const std::string& name);
    void addRoot(nlohmann::ordered_json node);
    void addLight(nlohmann::ordered_json light, nlohmann::ordered_json node);

    nlohmann::ordered_json json_;
    std::vector<uint8_t> binary_;
    std::vector<uint64_t> mesh_triangles_;
    uint64_t triangle_count_ = 0;
};
