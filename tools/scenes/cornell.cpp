#include "tools/scenes/scenes.h"

#include <numbers>

namespace
{

MaterialDescription wall(const char* name, Vec3 color)
{
    MaterialDescription material;
    material.name = name;
    material.base_color = color;
    material.lambert = true;
    return material;
}

} // namespace

GltfWriter cornellScene()
{
    GltfWriter gltf;
    const uint32_t white = gltf.addMaterial(wall("white", {0.73f, 0.73f, 0.73f}));
    const uint32_t red = gltf.addMaterial(wall("red", {0.61f, 0.06f, 0.055f}));
    const uint32_t green = gltf.addMaterial(wall("green", {0.12f, 0.45f, 0.15f}));
    MaterialDescription lamp = wall("lamp", {0.78f, 0.78f, 0.78f});
    lamp.emission = {26, 19, 9};
    const uint32_t light = gltf.addMaterial(lamp);

    // The room: x and z in +-0.5, y in 0..1, open towards +z.
    Mesh room;
    addQuad(room, {-0.5f, 0, 0.5f}, {1, 0, 0}, {0, 0, -1});
    addQuad(room, {-0.5f, 0, -0.5f}, {1, 0, 0}, {0, 1, 0});
    // The ceiling is a frame of four around the lamp, so that nothing overlaps.
    constexpr float kHalfX = 0.12f, kHalfZ = 0.10f;
    const auto ceiling = [](Mesh& mesh, float x0, float x1, float z0, float z1) {
        addQuad(mesh, {x0, 1, z0}, {x1 - x0, 0, 0}, {0, 0, z1 - z0});
    };
    ceiling(room, -0.5f, 0.5f, -0.5f, -kHalfZ);
    ceiling(room, -0.5f, 0.5f, kHalfZ, 0.5f);
    ceiling(room, -0.5f, -kHalfX, -kHalfZ, kHalfZ);
    ceiling(room, kHalfX, 0.5f, -kHalfZ, kHalfZ);
    gltf.add("room", room, white);

    Mesh left, right, panel;
    addQuad(left, {-0.5f, 0, 0.5f}, {0, 0, -1}, {0, 1, 0});
    addQuad(right, {0.5f, 0, -0.5f}, {0, 0, 1}, {0, 1, 0});
    ceiling(panel, -kHalfX, kHalfX, -kHalfZ, kHalfZ);
    gltf.add("left wall", left, red);
    gltf.add("right wall", right, green);
    gltf.add("lamp", panel, light);

    // Boxes stand on the floor: their undersides are lifted by a hair so that no two faces coincide.
    constexpr float kHair = 1e-4f;
    Mesh boxes;
    boxes.add(box({-0.15f, kHair, -0.15f}, {0.15f, 0.3f, 0.15f}), turned(-0.29f, {0.17f, 0, 0.17f}));
    boxes.add(box({-0.15f, kHair, -0.15f}, {0.15f, 0.6f, 0.15f}), turned(0.32f, {-0.17f, 0, -0.14f}));
    gltf.add("boxes", boxes, white);

    gltf.addCamera("front", {0, 0.5f, 1.95f}, {0, 0.5f, 0}, 2 * std::atan(0.5f / 1.47f));
    return gltf;
}
