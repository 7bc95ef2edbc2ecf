// Rooms that lose no light but through their windows: bright ones, and one on a ground that has no end.
#include "tools/scenes/rooms.h"
#include "tools/scenes/scenes.h"

GltfWriter brightScene(float albedo)
{
    GltfWriter gltf;
    const uint32_t walls = gltf.addMaterial(matte("walls", {albedo, albedo, albedo}));
    // Every albedo is lit to about the same brightness: power by absorption.
    const float radiance = 150 * (1 - albedo);
    const uint32_t light = gltf.addMaterial(glow("lamp", {radiance, radiance, radiance}));
    gltf.add("room", innerFaces({-2.1f, 0, -1.8f}, {2.1f, 2.8f, 1.8f}), walls);
    Mesh lamp;
    addQuad(lamp, {-0.2f, 2.6f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f});
    gltf.add("lamp", lamp, light);
    gltf.addCamera("inside", {-1.8f, 1.5f, 1.5f}, {1.0f, 1.1f, -0.9f}, 1.2f);
    return gltf;
}

GltfWriter plainScene(float ground)
{
    GltfWriter gltf;
    const uint32_t plaster = gltf.addMaterial(matte("plaster", {0.70f, 0.70f, 0.68f}));
    const uint32_t blue = gltf.addMaterial(matte("blue", {0.20f, 0.30f, 0.60f}));
    // 4 x 2.5 x 4 m inside, walls of 0.25 m, a window of 1.5 x 1.2 m at the greatest x.
    Mesh room = innerFaces({-2, 0, -2}, {2, 2.5f, 2}, false);
    addQuadAround(room, {2, 0, -2}, {0, 0, 4}, {0, 2.5f, 0}, {1.25f / 4, 2.75f / 4, 0.9f / 2.5f, 2.1f / 2.5f});
    const Vec3 low{-2.25f, -0.2f, -2.25f}, high{2.25f, 2.75f, 2.25f};
    addQuad(room, low, {4.5f, 0, 0}, {0, 0, 4.5f});
    addQuad(room, low, {0, 0, 4.5f}, {0, 2.95f, 0});
    addQuad(room, low, {0, 2.95f, 0}, {4.5f, 0, 0});
    addQuad(room, high, {-4.5f, 0, 0}, {0, -2.95f, 0});
    addQuad(room, high, {0, 0, -4.5f}, {-4.5f, 0, 0});
    addQuadAround(room, {2.25f, -0.2f, -2.25f}, {0, 2.95f, 0}, {0, 0, 4.5f},
                  {1.1f / 2.95f, 2.3f / 2.95f, 1.5f / 4.5f, 3.0f / 4.5f});
    // The window's reveal.
    const Vec3 through{0.25f, 0, 0}, up{0, 1.2f, 0}, along{0, 0, 1.5f};
    addQuad(room, {2, 0.9f, -0.75f}, along, through);
    addQuad(room, {2, 2.1f, -0.75f}, through, along);
    addQuad(room, {2, 0.9f, -0.75f}, through, up);
    addQuad(room, {2, 0.9f, 0.75f}, up, through);
    gltf.add("room", room, plaster);
    gltf.add("chest", box({-1.6f, 1e-3f, -1.5f}, {-0.7f, 0.7f, -0.8f}), blue);
    if (ground > 0)
    {
        Mesh plane;
        addQuad(plane, {-ground / 2, -0.25f, ground / 2}, {ground, 0, 0}, {0, 0, -ground});
        gltf.add("ground", plane, gltf.addMaterial(matte("ground", {0.25f, 0.24f, 0.22f})));
    }
    gltf.addSun("sun", {-0.7f, -0.6f, -0.2f}, {1, 0.95f, 0.88f}, 25);
    gltf.addCamera("inside", {1.6f, 1.5f, 1.7f}, {-1.4f, 0.9f, -1.4f}, 1.15f);
    return gltf;
}
