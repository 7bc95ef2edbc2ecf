// Rooms whose walls are single sheets: the light of two spaces lies on the two sides of the same triangles.
#include "tools/scenes/rooms.h"
#include "tools/scenes/scenes.h"

GltfWriter sheetsScene(double scale)
{
    GltfWriter gltf;
    const uint32_t walls = gltf.addMaterial(matte("walls", {0.72f, 0.70f, 0.65f}));
    const uint32_t wood = gltf.addMaterial(matte("wood", {0.55f, 0.36f, 0.20f}));
    // 5.6 x 2.7 x 4.4 m; the window is in the wall at the greatest x.
    const Vec3 low{-2.8f, 0, -2.2f}, high{2.8f, 2.7f, 2.2f};
    Mesh room = innerFaces(low, high, false);
    addQuadAround(room, {2.8f, 0, -2.2f}, {0, 0, 4.4f}, {0, 2.7f, 0}, {0.25f, 0.6f, 0.35f, 0.85f});
    gltf.add("room", room, walls);
    gltf.add("chest", box({-2.2f, 1e-3f, -1.7f}, {-1.0f, 0.8f, -1.1f}), wood);
    gltf.addSun("sun", {-0.75f, -0.55f, -0.2f}, {1, 0.96f, 0.9f}, 25);
    gltf.addCamera("inside", {2.4f, 1.6f, 1.8f}, {-1.8f, 0.9f, -1.2f}, 1.1f);
    if (scale != 1)
        gltf.place("scale", {}, scale);
    return gltf;
}

GltfWriter slotScene()
{
    GltfWriter gltf;
    const uint32_t walls = gltf.addMaterial(matte("walls", {0.70f, 0.68f, 0.66f}));
    const uint32_t red = gltf.addMaterial(matte("red", {0.60f, 0.25f, 0.18f}));
    // 9 x 6 x 7 m; the slot in the roof is 6 m long and 0.35 m wide.
    Mesh hall = innerFaces({-4.5f, 0, -3.5f}, {4.5f, 6, 3.5f}, true, false);
    addQuadAround(hall, {-4.5f, 6, -3.5f}, {9, 0, 0}, {0, 0, 7}, {1.5f / 9, 7.5f / 9, 1.5f / 7, 1.85f / 7});
    gltf.add("hall", hall, walls);
    gltf.add("block", box({-2.5f, 1e-3f, -1.2f}, {-1.1f, 2.2f, 0.2f}), red);
    gltf.addSun("sun", {0.2f, -1, 0.45f}, {1, 0.97f, 0.92f}, 120);
    gltf.addCamera("inside", {3.9f, 2.2f, 3.0f}, {-2.0f, 2.0f, -1.5f}, 1.1f);
    return gltf;
}

GltfWriter neighboursScene(bool bright_lamp)
{
    GltfWriter gltf;
    const uint32_t walls = gltf.addMaterial(matte("walls", {0.70f, 0.70f, 0.70f}));
    // Two rooms of 3.4 x 2.6 x 4 m; the right one's face at the least x is the left one's wall.
    Mesh rooms = innerFaces({-3.4f, 0, -2}, {0, 2.6f, 2});
    addQuad(rooms, {0, 0, -2}, {0, 0, 4}, {3.4f, 0, 0});
    addQuad(rooms, {0, 0, -2}, {3.4f, 0, 0}, {0, 2.6f, 0});
    addQuad(rooms, {3.4f, 2.6f, 2}, {0, -2.6f, 0}, {-3.4f, 0, 0});
    addQuad(rooms, {3.4f, 2.6f, 2}, {0, 0, -4}, {0, -2.6f, 0});
    addQuad(rooms, {3.4f, 2.6f, 2}, {-3.4f, 0, 0}, {0, 0, -4});
    gltf.add("rooms", rooms, walls);
    const auto lamp = [&](const char* name, float x, float radiance)
    {
        Mesh panel;
        addQuad(panel, {x - 0.25f, 2.5f, -0.25f}, {0.5f, 0, 0}, {0, 0, 0.5f});
        gltf.add(name, panel, gltf.addMaterial(glow(name, {radiance, radiance, radiance})));
    };
    lamp("dim lamp", -1.7f, 12);
    if (bright_lamp)
        lamp("bright lamp", 1.7f, 4800);
    gltf.addCamera("dim", {-3.1f, 1.5f, 1.7f}, {-0.2f, 1.1f, -1.0f}, 1.15f);
    return gltf;
}
