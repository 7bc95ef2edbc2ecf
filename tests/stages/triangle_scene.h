// Scenes given triangle by triangle, exactly as rays are to meet them: no glTF in between.
#pragma once
#include "compiler/scene_data.h"
#include "runtime/scene_gpu.h"

struct LoadedScene
{
    package::Package package;
    std::unique_ptr<SceneGpu> gpu;
};

/// Opaque, Lambert, white, roughness 1.
gpu::Material plainMaterial();

class TriangleScene
{
public:
    TriangleScene(); // has plainMaterial() as material 0

    /// @return its index
    uint32_t material(const gpu::Material& material);
    void triangle(gpu::vec3 a, gpu::vec3 b, gpu::vec3 c, uint32_t material = 0);
    /// Two triangles that share the diagonal from `corner`; they face along cross(u, v).
    void quad(gpu::vec3 corner, gpu::vec3 u, gpu::vec3 v, uint32_t material = 0);
    /// The six sides of an axis-parallel box, each of n x n quads whose shared vertices are the same floats.
    void box(gpu::vec3 low, gpu::vec3 high, uint32_t n);
    /// 2 n^2 quads on a sphere.
    void sphere(gpu::vec3 center, float radius, uint32_t n);

    const WorldMesh& mesh() const { return data_.mesh; }
    /// Without lights.
    LoadedScene load(const Device& device) const;

private:
    SceneData data_;
};
