#include "tests/stages/scene_builder.h"

#include "compiler/compile.h"
#include "format/check.h"
#include "image/write_image.h"
#include "tests/compiler/gltf_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

struct SceneBuilder::State
{
    TemporaryFolder folder;
    GltfBuilder gltf;
    std::set<std::string> extensions;
    bool has_environment = false;
    float environment_rotation = 0;
};

SceneBuilder::SceneBuilder() : state_(std::make_unique<State>())
{
    state_->gltf.json["scenes"][0]["nodes"].clear();
}
SceneBuilder::~SceneBuilder() = default;

namespace
{
void addRoot(nlohmann::json& gltf, int node)
{
    gltf["scenes"][0]["nodes"].push_back(node);
}

std::vector<float> flattened(const std::vector<gpu::vec3>& vectors)
{
    std::vector<float> floats;
    for (const gpu::vec3& v : vectors)
        floats.insert(floats.end(), {v.x, v.y, v.z});
    return floats;
}
} // namespace

void SceneBuilder::noteExtensions(const nlohmann::json& object)
{
    if (object.contains("extensions"))
        for (const auto& entry : object["extensions"].items())
            state_->extensions.insert(entry.key());
}

int SceneBuilder::material(const nlohmann::json& material)
{
    noteExtensions(material);
    return state_->gltf.material(material);
}

int SceneBuilder::texture(uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba)
{
    return state_->gltf.texture(width, height, rgba);
}

void SceneBuilder::mesh(const std::vector<gpu::vec3>& positions, const std::vector<gpu::vec3>& normals,
                        const std::vector<float>& uv, int material)
{
    GltfBuilder& gltf = state_->gltf;
    nlohmann::json attributes = {{"POSITION", gltf.positions(flattened(positions))},
                                 {"NORMAL", gltf.positions(flattened(normals))}};
    if (!uv.empty())
        attributes["TEXCOORD_0"] = gltf.accessor(uv, "VEC2", 5126, uv.size() / 2);
    addRoot(gltf.json, gltf.node({{"mesh", gltf.mesh({{"attributes", attributes}, {"material", material}})}}));
}

void SceneBuilder::quad(gpu::vec3 corner, gpu::vec3 edge_u, gpu::vec3 edge_v, int material)
{
    quad(corner, edge_u, edge_v, material, normalizeOr(cross(edge_u, edge_v), {0, 1, 0}));
}

void SceneBuilder::quad(gpu::vec3 corner, gpu::vec3 edge_u, gpu::vec3 edge_v, int material, gpu::vec3 normal)
{
    const gpu::vec3 b = corner + edge_u, c = corner + edge_u + edge_v, d = corner + edge_v;
    const std::vector<gpu::vec3> normals(6, normal);
    mesh({corner, b, c, corner, c, d}, normals, {0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1}, material);
}

void SceneBuilder::floor(float side, float height, int material)
{
    quad({-side / 2, height, side / 2}, {side, 0, 0}, {0, 0, -side}, material);
}

void SceneBuilder::box(gpu::vec3 low, gpu::vec3 high, int material, bool inwards)
{
    const gpu::vec3 size = high - low;
    const std::array<gpu::vec3, 3> edges{{{size.x, 0, 0}, {0, size.y, 0}, {0, 0, size.z}}};
    for (int axis = 0; axis < 3; ++axis)
    {
        const gpu::vec3 u = edges[size_t(axis + 1) % 3], v = edges[size_t(axis + 2) % 3]; // u x v points along axis
        quad(low + edges[size_t(axis)], inwards ? v : u, inwards ? u : v, material);
        quad(low, inwards ? u : v, inwards ? v : u, material);
    }
}

void SceneBuilder::sphere(gpu::vec3 center, float radius, int n, bool smooth, int material)
{
    const auto direction = [&](int i, int k)
    {
        const double theta = std::numbers::pi * i / n, phi = std::numbers::pi * (k % (2 * n)) / n;
        const double rim = i % n == 0 ? 0 : std::sin(theta);
        return gpu::vec3{float(rim * std::cos(phi)), float(std::cos(theta)), float(-rim * std::sin(phi))};
    };
    std::vector<gpu::vec3> positions, normals;
    const auto triangle = [&](const std::array<gpu::vec3, 3>& d)
    {
        const gpu::vec3 facet = normalizeOr(cross(d[1] - d[0], d[2] - d[0]), {0, 1, 0});
        for (const gpu::vec3& corner : d)
        {
            positions.push_back(center + corner * radius);
            normals.push_back(smooth ? corner : facet);
        }
    };
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < 2 * n; ++k)
        {
            if (i > 0)
                triangle({direction(i, k), direction(i + 1, k), direction(i, k + 1)});
            if (i + 1 < n)
                triangle({direction(i + 1, k), direction(i + 1, k + 1), direction(i, k + 1)});
        }
    mesh(positions, normals, {}, material);
}

void SceneBuilder::light(const nlohmann::json& light, const nlohmann::json& node, const nlohmann::json& parent)
{
    GltfBuilder& gltf = state_->gltf;
    nlohmann::json& lights = gltf.json["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(light);
    nlohmann::json child = node;
    child["extensions"]["KHR_lights_punctual"]["light"] = lights.size() - 1;
    noteExtensions(child);
    nlohmann::json above = parent;
    above["children"] = {gltf.node(child)};
    addRoot(gltf.json, gltf.node(above));
}

void SceneBuilder::environment(const ImageF& map, float rotation)
{
    const Status status = writeExr(state_->folder / "environment.exr", map);
    check(bool(status), "{}", status ? "" : status.error().message);
    state_->has_environment = true;
    state_->environment_rotation = rotation;
}

std::filesystem::path SceneBuilder::compile()
{
    if (!state_->extensions.empty())
        state_->gltf.json["extensionsUsed"] = state_->extensions;
    state_->gltf.writeGltf(state_->folder / "scene.gltf");
    CompileOptions options{.input = state_->folder / "scene.gltf", .output = state_->folder / "scene.lumi"};
    options.default_light = DefaultLight::kOff;
    if (state_->has_environment)
        options.environment = state_->folder / "environment.exr";
    options.environment_rotation = state_->environment_rotation;
    const auto report = ::compile(options);
    check(bool(report), "{}", report ? "" : report.error().message);
    return options.output;
}

nlohmann::json lambert(double albedo)
{
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {albedo, albedo, albedo, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
            {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}, {"specularColorFactor", {0, 0, 0}}}}}}};
}

nlohmann::json emitter(double radiance)
{
    return with(lambert(0), {{"emissiveFactor", {1, 1, 1}},
                             {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", radiance}}}}}});
}

nlohmann::json with(nlohmann::json material, const nlohmann::json& patch)
{
    material.merge_patch(patch);
    return material;
}
