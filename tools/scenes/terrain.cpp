// A landscape of a given number of triangles, to measure how the compiler's time and memory grow.
#include "tools/scenes/rooms.h"
#include "tools/scenes/scenes.h"

#include <algorithm>
#include <cmath>

namespace
{
constexpr float kSide = 400; // metres

float height(float x, float z)
{
    return 6 * std::sin(0.031f * x) * std::cos(0.043f * z) + 0.8f * std::sin(0.37f * x + 0.21f * z) +
           0.05f * std::cos(2.9f * x - 3.7f * z);
}
} // namespace

GltfWriter terrainScene(uint32_t triangles)
{
    GltfWriter gltf;
    const uint32_t grass = gltf.addMaterial(matte("grass", {0.25f, 0.35f, 0.12f}));
    const uint32_t stone = gltf.addMaterial(matte("stone", {0.45f, 0.43f, 0.40f}));
    // Half of them in the ground, half in boulders that lie on it: large even meshes, and many small ones that overlap.
    const auto cells = uint32_t(std::sqrt(double(triangles) / 4));
    gltf.add("ground",
             sheet(cells, cells, {kSide, kSide},
                   [](float s, float t)
                   {
                       const float x = (s - 0.5f) * kSide, z = (0.5f - t) * kSide;
                       return Vec3{x, height(x, z), z};
                   }),
             grass);
    const Mesh ball = sphere(1, 32, 16);
    const auto boulder_count = uint32_t(triangles / 2 / (ball.indices.size() / 3));
    const uint32_t boulder = gltf.addMesh("boulder", ball, stone);
    for (uint32_t i = 0; i < boulder_count; ++i)
    {
        // Two incommensurable steps spread the boulders evenly and never put two in one place.
        const float x = (std::fmod(0.7548776662f * float(i), 1.0f) - 0.5f) * kSide;
        const float z = (std::fmod(0.5698402910f * float(i), 1.0f) - 0.5f) * kSide;
        gltf.addNode("boulder", boulder, {x, height(x, z) + 0.3f * std::sin(float(i)), z}, float(i));
    }
    gltf.addSun("sun", {0.4f, -0.8f, -0.3f}, {1, 0.95f, 0.85f}, 8);
    gltf.addCamera("hill", {0, 14, 120}, {0, 2, 0}, 0.9f);
    return gltf;
}
