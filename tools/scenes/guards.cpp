// Small scenes, each about one thing that files do and renderers get wrong.
#include "tools/scenes/rooms.h"
#include "tools/scenes/scenes.h"

GltfWriter farScene(bool at_map_coordinates)
{
    GltfWriter gltf;
    const uint32_t grey = gltf.addMaterial(matte("grey", {0.62f, 0.60f, 0.57f}));
    const uint32_t green = gltf.addMaterial(matte("green", {0.20f, 0.50f, 0.25f}));
    // A court of 7 x 3 x 6 m, open above and at the greatest x, where it goes on as a terrace.
    Mesh court = innerFaces({-3.5f, 0, -3}, {3.5f, 3, 3}, false, false);
    gltf.add("court", court, grey);
    gltf.add("step", box({-0.4f, 1e-3f, -2.4f}, {0.8f, 0.5f, -1.2f}), green);
    Mesh ball;
    ball.add(sphere(0.6f, 32, 16), at(-1.5f, 0.6f + 1e-3f, -0.6f));
    gltf.add("ball", ball, green);
    gltf.addPoint("lantern", {1.6f, 2.2f, -1.0f}, {1, 0.85f, 0.6f}, 9);
    gltf.addSpot("spot", {-2.6f, 2.8f, 2.0f}, {0.35f, -1, -0.9f}, {0.8f, 0.9f, 1}, 40, 0.3f, 0.5f);
    gltf.addCamera("court", {3.0f, 1.9f, 2.5f}, {-0.9f, 0.6f, -1.0f}, 1.0f);
    // Metres east and north of a zone's origin, as surveys have them; north is -z.
    if (at_map_coordinates)
        gltf.place("site", {691607.4, 518.3, -5334758.9}, 1);
    else
        gltf.place("site", {}, 1);
    return gltf;
}

GltfWriter decalScene(bool decal)
{
    GltfWriter gltf;
    // A disc of the wall's colour within a transparent rim: which of the two is seen there does not matter.
    Texture label{.size = 256, .rgb = {}, .alpha = {}};
    for (int y = 0; y < 256; ++y)
    {
        for (int x = 0; x < 256; ++x)
        {
            const int distance_squared = (2 * x - 255) * (2 * x - 255) + (2 * y - 255) * (2 * y - 255);
            label.rgb.insert(label.rgb.end(), {255, 255, 255});
            label.alpha.push_back(distance_squared < 160 * 160 ? 255 : 0);
        }
    }
    MaterialDescription cut_out = matte("label", {0.60f, 0.60f, 0.60f});
    cut_out.base_color_texture = gltf.addTexture("label", label);
    cut_out.alpha_cutoff = 0.5f;
    const uint32_t decal_material = gltf.addMaterial(cut_out);
    const uint32_t wall_material = gltf.addMaterial(matte("wall", {0.60f, 0.60f, 0.60f}));
    Mesh wall, card, behind, floor;
    addQuad(wall, {-2.5f, 0, 0}, {5, 0, 0}, {0, 3, 0});
    addQuad(card, {-0.9f, 0.6f, 0}, {1.8f, 0, 0}, {0, 1.8f, 0});
    card.scaleUvs(1 / 1.8f);
    addQuad(floor, {-2.5f, 0, 2.5f}, {5, 0, 0}, {0, 0, -2.5f});
    addQuad(behind, {-2.5f, 0, -0.8f}, {5, 0, 0}, {0, 3, 0});
    if (decal)
        gltf.add("decal", card, decal_material);
    gltf.add("wall", wall, wall_material);
    gltf.add("floor", floor, wall_material);
    gltf.add("glow behind", behind, gltf.addMaterial(glow("glow", {0, 8, 0}))); // shows holes
    gltf.addSun("sun", {0.3f, -0.6f, -1}, {1, 1, 1}, 4);
    gltf.addCamera("front", {0, 1.6f, 4.2f}, {0, 1.3f, 0}, 0.75f);
    return gltf;
}

GltfWriter terminatorScene(bool fine)
{
    GltfWriter gltf;
    const uint32_t clay = gltf.addMaterial(matte("clay", {0.55f, 0.48f, 0.42f}));
    const uint32_t floor_material = gltf.addMaterial(matte("floor", {0.35f, 0.35f, 0.35f}));
    Mesh floor, balls;
    addQuad(floor, {-4, 0, 2.5f}, {8, 0, 0}, {0, 0, -5});
    const uint32_t segments[3] = {16, 24, 36};
    for (int i = 0; i < 3; ++i)
    {
        const uint32_t around = fine ? 96 : segments[i];
        balls.add(sphere(0.8f, around, around / 2), at(2.1f * float(i - 1), 0.85f, 0));
    }
    gltf.add("floor", floor, floor_material);
    gltf.add("balls", balls, clay);
    gltf.addSun("sun", {-0.9f, -0.5f, -0.25f}, {1, 1, 1}, 4);
    gltf.addCamera("front", {0, 1.7f, 7.0f}, {0, 0.8f, 0}, 0.5f);
    return gltf;
}

GltfWriter flippedScene(bool against)
{
    GltfWriter gltf;
    const auto turnedNormals = [&](Mesh mesh)
    {
        if (against)
            for (Vec3& normal : mesh.normals)
                normal = -normal;
        return mesh;
    };
    const uint32_t white = gltf.addMaterial(matte("white", {0.65f, 0.65f, 0.65f}));
    const uint32_t orange = gltf.addMaterial(matte("orange", {0.70f, 0.40f, 0.15f}));
    Mesh corner, ball;
    addQuad(corner, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
    addQuad(corner, {-2, 0, -2}, {4, 0, 0}, {0, 2.6f, 0});
    addQuad(corner, {-2, 0, -2}, {0, 2.6f, 0}, {0, 0, 4});
    ball.add(sphere(0.5f, 64, 32), at(0.6f, 0.5f + 1e-3f, 0.2f));
    gltf.add("corner", turnedNormals(corner), white);
    gltf.add("box", turnedNormals(box({-1.4f, 1e-3f, -1.4f}, {-0.4f, 1.1f, -0.5f})), orange);
    gltf.add("ball", turnedNormals(ball), orange);
    gltf.addSun("sun", {-0.6f, -1, -0.7f}, {1, 0.97f, 0.9f}, 4);
    gltf.addPoint("bulb", {1.2f, 1.8f, -1.0f}, {0.7f, 0.85f, 1}, 3);
    gltf.addCamera("corner", {2.6f, 1.9f, 3.2f}, {-0.3f, 0.7f, -0.4f}, 0.75f);
    return gltf;
}

GltfWriter shieldScene(bool lamp)
{
    GltfWriter gltf;
    const uint32_t grey = gltf.addMaterial(matte("grey", {0.5f, 0.5f, 0.5f}));
    constexpr float kHeight = 30;
    Mesh floor, shield;
    addQuad(floor, {-10, 0, 10}, {20, 0, 0}, {0, 0, -20});
    addQuad(shield, {-0.3f, kHeight - 0.002f, 0.3f}, {0.6f, 0, 0}, {0, 0, -0.6f});
    gltf.add("floor", floor, grey);
    gltf.add("post", box({-1, 1e-3f, -1}, {1, 2, 1}), grey);
    gltf.add("shield", shield, grey);
    gltf.addSun("dim sun", {-0.5f, -1, -0.3f}, {1, 1, 1}, 0.5f);
    if (lamp)
        gltf.addPoint("lamp", {0, kHeight, 0}, {1, 1, 1}, 4 * kHeight * kHeight);
    gltf.addCamera("floor", {0, 5, 15}, {0, 0.6f, 0}, 0.6f);
    return gltf;
}
