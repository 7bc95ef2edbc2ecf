#include "tests/stages/triangle_scene.h"

#include "compiler/build_bvh.h"
#include "compiler/build_lights.h"
#include "compiler/encode.h"
#include "compiler/gltf_material.h"
#include "compiler/package_meta.h"
#include "format/material.h"
#include "tests/tools/temporary_folder.h"

#include <cmath>
#include <numbers>

namespace
{
template <typename T>
package::ChunkSource chunk(uint32_t id, const std::vector<T>& data)
{
    return {id, 0, std::as_bytes(std::span(data))};
}
} // namespace

gpu::Material plainMaterial()
{
    gpu::Material m = package::defaultMaterial();
    m.metallic = 0;
    m.specular = 0;
    m.specular_color = {};
    return m;
}

TriangleScene::TriangleScene()
{
    data_.cameras.push_back({.name = "unused", .vertical_fov = 1});
    data_.mesh.object_count = 1;
    material(plainMaterial());
}

uint32_t TriangleScene::material(const gpu::Material& material)
{
    data_.materials.push_back(material);
    data_.material_names.emplace_back("material");
    return uint32_t(data_.materials.size() - 1);
}

void TriangleScene::triangle(gpu::vec3 a, gpu::vec3 b, gpu::vec3 c, uint32_t material)
{
    WorldMesh& mesh = data_.mesh;
    const uint32_t first = uint32_t(mesh.positions.size());
    const gpu::uvec2 white = encodeColor(1, 1, 1, 1);
    const gpu::vec3 normal = normalizeOr(cross(b - a, c - a), {0, 1, 0});
    for (const gpu::vec3& corner : {a, b, c})
    {
        mesh.positions.push_back(corner);
        mesh.attributes.push_back({.normal = encodeNormal(normal), .tangent = 0, .uv0 = {}, .uv1 = {}, .color = white});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.materials.push_back(material);
    mesh.objects.push_back(0);
}

void TriangleScene::quad(gpu::vec3 corner, gpu::vec3 u, gpu::vec3 v, uint32_t material)
{
    const gpu::vec3 opposite = corner + u + v;
    triangle(corner, corner + u, opposite, material);
    triangle(corner, opposite, corner + v, material);
}

void TriangleScene::box(gpu::vec3 low, gpu::vec3 high, uint32_t n)
{
    const auto at = [&](uint32_t i, float from, float to)
    { return i == n ? to : from + (to - from) * float(i) / float(n); };
    const std::array<float, 3> from{low.x, low.y, low.z}, to{high.x, high.y, high.z};
    for (size_t axis = 0; axis < 3; ++axis)
        for (const bool upper : {false, true})
        {
            const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
            const auto corner = [&](uint32_t i, uint32_t k)
            {
                std::array<float, 3> p{};
                p[axis] = upper ? to[axis] : from[axis];
                p[u] = at(i, from[u], to[u]);
                p[v] = at(k, from[v], to[v]);
                return gpu::vec3{p[0], p[1], p[2]};
            };
            for (uint32_t i = 0; i < n; ++i)
                for (uint32_t k = 0; k < n; ++k)
                {
                    triangle(corner(i, k), corner(i + 1, k), corner(i + 1, k + 1));
                    triangle(corner(i, k), corner(i + 1, k + 1), corner(i, k + 1));
                }
        }
}

void TriangleScene::sphere(gpu::vec3 center, float radius, uint32_t n)
{
    const auto corner = [&](uint32_t i, uint32_t k)
    {
        const double theta = std::numbers::pi * i / n, phi = std::numbers::pi * (k % (2 * n)) / n;
        const double rim = i % n == 0 ? 0 : std::sin(theta); // the poles are one point each
        return center +
               gpu::vec3{float(rim * std::cos(phi)), float(std::cos(theta)), float(rim * std::sin(phi))} * radius;
    };
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t k = 0; k < 2 * n; ++k)
        {
            if (i > 0)
                triangle(corner(i, k), corner(i, k + 1), corner(i + 1, k));
            if (i + 1 < n)
                triangle(corner(i, k + 1), corner(i + 1, k + 1), corner(i + 1, k));
        }
}

LoadedScene TriangleScene::load(const Device& device) const
{
    const LightTables lights = buildLights(data_);
    const std::vector<uint32_t> by_material = materialTriangleFlags(data_);
    std::vector<uint32_t> flags;
    for (const uint32_t m : data_.mesh.materials)
        flags.push_back(by_material[m]);
    const Bvh bvh = buildBvh(data_.mesh, flags);
    const std::vector<uint8_t> meta = encodeMeta(makeMeta({}, data_, bvh, lights, {}, nullptr));
    const package::StoredGeometry geometry = foldGeometry(data_.mesh, bvh);
    std::vector<package::ChunkSource> chunks = geometry.chunks();
    chunks.push_back(chunk(package::kMetaChunk, meta));
    chunks.push_back(chunk(package::kMaterialsChunk, data_.materials));
    const TemporaryFolder folder;
    const auto written = package::write(folder / "scene.lumi", chunks, {});
    check(bool(written), "{}", written ? "" : written.error().message);
    auto package = package::Package::open(folder / "scene.lumi");
    check(bool(package), "{}", package ? "" : package.error().message);
    auto scene = SceneGpu::create(device, *package);
    check(bool(scene), "{}", scene ? "" : scene.error().message);
    return {.package = std::move(*package), .gpu = std::move(*scene)};
}
