#include "tools/scenes/scenes.h"

#include <numbers>

GltfWriter causticsScene()
{
    GltfWriter gltf;
    MaterialDescription wall;
    wall.name = "wall";
    wall.base_color = {0.58f, 0.60f, 0.63f};
    wall.lambert = true;
    const uint32_t walls = gltf.addMaterial(wall);
    wall.name = "table";
    wall.base_color = {0.68f, 0.66f, 0.62f};
    const uint32_t table = gltf.addMaterial(wall);

    MaterialDescription glass;
    glass.name = "glass";
    glass.roughness = 0;
    glass.transmission = 1;
    glass.thickness = 0.24f;
    const uint32_t clear = gltf.addMaterial(glass);

    MaterialDescription gold;
    gold.name = "gold";
    gold.base_color = {1.0f, 0.78f, 0.34f};
    gold.metallic = 1;
    gold.roughness = 0;
    const uint32_t metal = gltf.addMaterial(gold);

    MaterialDescription lamp;
    lamp.name = "lamp";
    lamp.base_color = {0, 0, 0};
    lamp.lambert = true;
    lamp.emission = {1100, 1000, 820};
    const uint32_t light = gltf.addMaterial(lamp);

    // A closed room of 2 x 1.6 x 2 m; its floor is the table top.
    Mesh top, room;
    addQuad(top, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
    addQuad(room, {-1, 0, -1}, {2, 0, 0}, {0, 1.6f, 0});
    addQuad(room, {1, 0, 1}, {-2, 0, 0}, {0, 1.6f, 0});
    addQuad(room, {-1, 0, 1}, {0, 0, -2}, {0, 1.6f, 0});
    addQuad(room, {1, 0, -1}, {0, 0, 2}, {0, 1.6f, 0});
    addQuad(room, {-1, 1.6f, -1}, {2, 0, 0}, {0, 0, 2});
    gltf.add("table", top, table);
    gltf.add("room", room, walls);

    // The sphere floats a hair above the table: touching would leave the light no way in at the contact point.
    constexpr float kRadius = 0.12f;
    Mesh ball;
    ball.add(sphere(kRadius, 192, 96), at(-0.20f, kRadius + 5e-4f, 0.02f));
    gltf.add("glass sphere", ball, clear);

    // A band bent to a ring: its inside draws the cardioid.
    std::vector<Vec2> band;
    constexpr float kRing = 0.15f, kHalfWidth = 0.008f, kHeight = 0.07f, kRound = 0.004f;
    const Vec2 centers[4] = {{kRing + kHalfWidth - kRound, kHeight - kRound},
                             {kRing - kHalfWidth + kRound, kHeight - kRound},
                             {kRing - kHalfWidth + kRound, kRound},
                             {kRing + kHalfWidth - kRound, kRound}};
    for (int i = 0; i < 4; ++i)
    {
        for (int step = 0; step <= 8; ++step)
        {
            const float angle = std::numbers::pi_v<float> * 0.5f * (float(i) + float(step) / 8);
            band.push_back({centers[i].x + kRound * std::cos(angle), centers[i].y + kRound * std::sin(angle)});
        }
    }
    Mesh hoop;
    hoop.add(ring(band, 256), at(0.22f, 5e-4f, 0.06f));
    gltf.add("gold ring", hoop, metal);

    // The lamp shines down and inwards from the upper left.
    Mesh bulb;
    addQuad(bulb, {-0.02f, 0, -0.02f}, {0.04f, 0, 0}, {0, 0, 0.04f});
    Mesh hung;
    const Vec3 down = normalize({0.72f, -1.0f, 0.30f});
    const Vec3 x = normalize(cross({0, 0, 1}, down)); // so that the quad's own -y turns to `down`
    hung.add(bulb, {-x, -down, cross(-x, -down), {-0.62f, 0.98f, -0.32f}});
    gltf.add("lamp", hung, light);

    gltf.addCamera("table", {0.05f, 0.62f, 0.92f}, {0.02f, 0.05f, 0.0f}, 0.62f);
    return gltf;
}
