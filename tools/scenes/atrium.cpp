// The hall: x in +-6, z in +-12, y in 0..10. Colonnades at x = +-3.25 carry a gallery at 4.75 m over vaulted aisles; a
// shaft in the roof lets in the sun. One long side is built at x > 0 and used twice, turned by half a circle.
#include "tools/scenes/atrium_materials.h"
#include "tools/scenes/atrium_parts.h"
#include "tools/scenes/scenes.h"

#include <numbers>

namespace
{

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kHalfLength = 12, kHalfWidth = 6, kRoof = 10;
constexpr float kBay = 3;
constexpr int kBayCount = 8;
constexpr float kArcade = 3.0f; // x of the arcade's front
constexpr float kArcadeDepth = 0.5f;
constexpr float kSpring = 2.9f, kGallery = 4.75f, kUpperSpring = 7.3f, kUpperCeiling = 9.3f;
constexpr float kFoot = 0.02f;             // how far walls reach into what carries them
constexpr Vec3 kSun{0.25f, -1.0f, -0.36f}; // the way its light travels
constexpr float kSkyHalfX = 2.0f, kSkyHalfZ = 6.8f, kSkyHeight = 5.0f;

/// A wall arcade whose front faces -x at x = kArcade: bay after bay along z.
Placement bayPlacement(int bay, float x, float y)
{
    return turned(-0.5f * kPi, {x, y, -kHalfLength + kBay * (float(bay) + 0.5f)});
}

float columnZ(int i)
{
    return -kHalfLength + kBay * float(i);
}

void addArcades(GltfWriter& gltf, const AtriumMaterials& m, float turn)
{
    const float radius = 1.2f, upper_radius = 1.24f;
    const Mesh lower_bay = archBay(kBay, kGallery - kSpring, radius, kHalfWidth - kArcade, kFoot, false, 20);
    const Mesh upper_bay = archBay(kBay, kRoof - kUpperSpring, upper_radius, kArcadeDepth, kFoot, true, 20);
    const Mesh lower_moulding = archMoulding({{radius + 0.005f, -0.02f},
                                              {radius + 0.005f, 0.03f},
                                              {radius + 0.10f, 0.03f},
                                              {radius + 0.11f, 0.055f},
                                              {radius + 0.20f, 0.055f},
                                              {radius + 0.23f, -0.01f}},
                                             20);
    const Mesh upper_moulding = archMoulding({{upper_radius + 0.005f, -0.02f},
                                              {upper_radius + 0.005f, 0.03f},
                                              {upper_radius + 0.12f, 0.03f},
                                              {upper_radius + 0.16f, -0.01f}},
                                             20);
    Mesh walls, mouldings;
    for (int bay = 0; bay < kBayCount; ++bay)
    {
        walls.add(lower_bay, bayPlacement(bay, kArcade, kSpring));
        walls.add(upper_bay, bayPlacement(bay, kArcade, kUpperSpring));
        mouldings.add(lower_moulding, bayPlacement(bay, kArcade, kSpring));
        mouldings.add(upper_moulding, bayPlacement(bay, kArcade, kUpperSpring));
    }
    // Flat soffits between the aisle's vaults, and the pilasters on which they rest.
    const float half = 0.5f * kBay - radius;
    for (int i = 0; i <= kBayCount; ++i)
    {
        const float z0 = std::max(columnZ(i) - half, -kHalfLength), z1 = std::min(columnZ(i) + half, kHalfLength);
        addQuad(walls, {kArcade, kSpring - kFoot, z0}, {kHalfWidth - kArcade, 0, 0}, {0, 0, z1 - z0});
        addQuad(walls, {kArcade, kUpperSpring - kFoot, z0}, {kArcadeDepth, 0, 0}, {0, 0, z1 - z0});
        mouldings.add(box({kHalfWidth - 0.16f, -0.01f, columnZ(i) - 0.26f},
                          {kHalfWidth + 0.05f, kSpring - 0.18f, columnZ(i) + 0.26f}, 0.015f));
        mouldings.add(box({kHalfWidth - 0.20f, kSpring - 0.18f, columnZ(i) - 0.29f},
                          {kHalfWidth + 0.05f, kSpring, columnZ(i) + 0.29f}, 0.015f));
    }
    for (float z : {-kHalfLength, kHalfLength}) // responds where the arcade meets the end walls
    {
        const float inside = z < 0 ? 1.0f : -1.0f;
        const auto respond = [&](float y0, float y1, float depth, float spread)
        {
            const float a = z - 0.05f * inside, b = z + depth * inside;
            mouldings.add(box({kArcade - spread, y0, std::min(a, b)},
                              {kArcade + kArcadeDepth + spread, y1, std::max(a, b)}, 0.012f));
        };
        respond(-0.01f, kSpring - 0.16f, 0.27f, 0.0f);
        respond(kSpring - 0.16f, kSpring, 0.32f, 0.05f);
        respond(kGallery - 0.01f, kUpperSpring - 0.14f, 0.22f, 0.0f);
        respond(kUpperSpring - 0.14f, kUpperSpring, 0.27f, 0.04f);
    }
    walls.scaleUvs(0.5f);
    gltf.addNode("arcade", gltf.addMesh("arcade", walls, m.plaster), {}, turn);
    gltf.addNode("mouldings", gltf.addMesh("mouldings", mouldings, m.limestone), {}, turn);
}

void addGallery(GltfWriter& gltf, const AtriumMaterials& m, float turn)
{
    Mesh stone;
    // The string course below the gallery and the cornice below the roof.
    for (const auto& [y0, y1, out] : {std::tuple{4.42f, 4.52f, 0.06f},
                                      {4.52f, 4.68f, 0.12f},
                                      {4.68f, 4.79f, 0.19f},
                                      {9.42f, 9.55f, 0.08f},
                                      {9.55f, 9.75f, 0.16f},
                                      {9.75f, 10.05f, 0.24f}})
        stone.add(box({kArcade - out, y0, -kHalfLength - 0.05f}, {kArcade + 0.03f, y1, kHalfLength + 0.05f}, 0.015f));
    // Balustrade: plinth, rail, and piers in front of the columns.
    const float front = kArcade - 0.13f, back = kArcade + 0.05f;
    stone.add(
        box({front, kGallery + 0.03f, -kHalfLength - 0.05f}, {back, kGallery + 0.13f, kHalfLength + 0.05f}, 0.012f));
    stone.add(box({front - 0.02f, kGallery + 0.83f, -kHalfLength - 0.05f},
                  {back + 0.02f, kGallery + 0.94f, kHalfLength + 0.05f}, 0.02f));
    for (int i = 1; i < kBayCount; ++i)
        stone.add(box({front - 0.01f, kGallery + 0.04f, columnZ(i) - 0.14f},
                      {back + 0.01f, kGallery + 0.97f, columnZ(i) + 0.14f}, 0.015f));
    gltf.addNode("cornices", gltf.addMesh("cornices", stone, m.limestone), {}, turn);

    Mesh row;
    for (int i = 0; i < 8; ++i)
        row.add(baluster(), at(0.5f * (front + back), kGallery + 0.12f, -1.5f + 0.30f + 0.342f * float(i)));
    const uint32_t balusters = gltf.addMesh("balusters", row, m.marble);
    const float side = turn == 0 ? 1.0f : -1.0f;
    for (int bay = 0; bay < kBayCount; ++bay)
        gltf.addNode("balusters", balusters, {0, 0, side * (columnZ(bay) + 1.5f)}, turn);

    Mesh floor, ceiling;
    addQuad(floor, {kArcade, kGallery, kHalfLength}, {kHalfWidth - kArcade, 0, 0}, {0, 0, -2 * kHalfLength});
    addQuad(ceiling, {kArcade + kArcadeDepth, kUpperCeiling, -kHalfLength}, {kHalfWidth - kArcade - kArcadeDepth, 0, 0},
            {0, 0, 2 * kHalfLength});
    floor.scaleUvs(0.5f);
    gltf.addNode("gallery floor", gltf.addMesh("gallery floor", floor, m.tiles), {}, turn);
    for (int i = 0; i <= 2 * kBayCount; ++i) // joists
    {
        const float z = -kHalfLength + 1.5f * float(i);
        ceiling.add(box({kArcade + kArcadeDepth - 0.02f, kUpperCeiling - 0.16f, z - 0.07f},
                        {kHalfWidth + 0.05f, kUpperCeiling + 0.02f, z + 0.07f}, 0.01f));
    }
    gltf.addNode("gallery ceiling", gltf.addMesh("gallery ceiling", ceiling, m.planks), {}, turn);
}

void addColumns(GltfWriter& gltf, const AtriumMaterials& m)
{
    const uint32_t lower = gltf.addMesh("column", lowerColumn(kSpring), m.limestone);
    const uint32_t upper = gltf.addMesh("gallery column", upperColumn(kUpperSpring - kGallery), m.limestone);
    for (float side : {-1.0f, 1.0f})
    {
        for (int i = 1; i < kBayCount; ++i)
        {
            const float x = side * (kArcade + 0.5f * kArcadeDepth);
            gltf.addNode("column", lower, {x, 0, columnZ(i)});
            gltf.addNode("gallery column", upper, {x, kGallery, columnZ(i)});
        }
    }
}

void addShell(GltfWriter& gltf, const AtriumMaterials& m)
{
    Mesh floor;
    addQuad(floor, {-kHalfWidth, 0, kHalfLength}, {2 * kHalfWidth, 0, 0}, {0, 0, -2 * kHalfLength});
    floor.scaleUvs(0.5f);
    gltf.add("floor", floor, m.tiles);

    Mesh lower, upper;
    for (float turn : {0.0f, kPi})
    {
        Mesh side, end, high;
        addQuad(side, {kHalfWidth, 0, -kHalfLength}, {0, 0, 2 * kHalfLength}, {0, kGallery, 0});
        addQuad(high, {kHalfWidth, kGallery, -kHalfLength}, {0, 0, 2 * kHalfLength}, {0, kRoof - kGallery, 0});
        addQuad(end, {-kHalfWidth, 0, -kHalfLength}, {2 * kHalfWidth, 0, 0}, {0, kRoof, 0});
        lower.add(side, turned(turn, {}));
        upper.add(high, turned(turn, {}));
        upper.add(end, turned(turn, {}));
    }
    lower.scaleUvs(1 / 1.5f);
    upper.scaleUvs(0.5f);
    gltf.add("aisle walls", lower, m.brick);
    gltf.add("walls", upper, m.plaster);

    // A thicker skin outside keeps the sun from finding its way through the seams of the inner one.
    Mesh skin;
    const float t = 0.3f, x = kHalfWidth + t, z = kHalfLength + t, y = kRoof + 0.1f;
    skin.add(box({kHalfWidth + 0.1f, -t, -z}, {x, y, z}));
    skin.add(box({-x, -t, -z}, {-kHalfWidth - 0.1f, y, z}));
    skin.add(box({-x, -t, kHalfLength + 0.1f}, {x, y, z}));
    skin.add(box({-x, -t, -z}, {x, y, -kHalfLength - 0.1f}));
    skin.add(box({-x, -t, -z}, {x, -0.1f, z}));
    for (float side : {-1.0f, 1.0f})
    {
        skin.add(box({side > 0 ? kSkyHalfX + 0.02f : -x, y, -z}, {side > 0 ? x : -kSkyHalfX - 0.02f, y + t, z}));
        skin.add(box({-x, y, side > 0 ? kSkyHalfZ + 0.02f : -z}, {x, y + t, side > 0 ? z : -kSkyHalfZ - 0.02f}));
    }
    gltf.add("outer skin", skin, m.plaster);
}

void addRoof(GltfWriter& gltf, const AtriumMaterials& m)
{
    Mesh planks;
    const auto ceiling = [&](float x0, float x1, float z0, float z1) {
        addQuad(planks, {x0, kRoof, z0}, {x1 - x0, 0, 0}, {0, 0, z1 - z0});
    };
    ceiling(-kHalfWidth, kHalfWidth, -kHalfLength, -kSkyHalfZ);
    ceiling(-kHalfWidth, kHalfWidth, kSkyHalfZ, kHalfLength);
    ceiling(-kHalfWidth, -kSkyHalfX, -kSkyHalfZ, kSkyHalfZ);
    ceiling(kSkyHalfX, kHalfWidth, -kSkyHalfZ, kSkyHalfZ);
    for (int i = 1; i < kBayCount; ++i) // tie beams over every column
        planks.add(box({-kArcade - 0.05f, kRoof - 0.34f, columnZ(i) - 0.13f},
                       {kArcade + 0.05f, kRoof - 0.02f, columnZ(i) + 0.13f}, 0.02f));
    for (float side : {-1.0f, 1.0f}) // and the trimmers of the opening
        planks.add(box({side * kSkyHalfX - (side < 0 ? 0.18f : 0.0f), kRoof - 0.22f, -kSkyHalfZ - 0.18f},
                       {side * kSkyHalfX + (side > 0 ? 0.18f : 0.0f), kRoof + 0.06f, kSkyHalfZ + 0.18f}, 0.015f));
    gltf.add("roof", planks, m.planks);

    // The shaft follows the sun's direction, so that it shades nothing; its glowing walls stand in for the sky.
    Mesh sky;
    const float k = kSkyHeight / -kSun.y;
    const Vec3 up = kSun * -k;
    const float x = kSkyHalfX, z = kSkyHalfZ, y = kRoof + 0.07f;
    addQuad(sky, {-x, y, z}, {0, 0, -2 * z}, up);
    addQuad(sky, {x, y, -z}, {0, 0, 2 * z}, up);
    addQuad(sky, {-x, y, -z}, {2 * x, 0, 0}, up);
    addQuad(sky, {x, y, z}, {-2 * x, 0, 0}, up);
    gltf.add("sky shaft", sky, m.sky);
    gltf.addSun("sun", kSun, {1.0f, 0.91f, 0.76f}, 25);
}

void addBanners(GltfWriter& gltf, const AtriumMaterials& m)
{
    Mesh rods;
    const auto hang = [&](int color, float width, float drop, Placement placement, float phase)
    {
        Mesh cloth;
        cloth.add(banner(width, drop, 0.07f, phase), placement);
        gltf.add("banner", cloth, m.cloth[color]);
        const Mesh rod = lathe({{0, -0.5f * width - 0.12f},
                                {0.035f, -0.5f * width - 0.12f},
                                {0.035f, -0.5f * width - 0.06f},
                                {0.018f, -0.5f * width - 0.05f},
                                {0.018f, 0.5f * width + 0.05f},
                                {0.035f, 0.5f * width + 0.06f},
                                {0.035f, 0.5f * width + 0.12f},
                                {0, 0.5f * width + 0.12f}},
                               12);
        Placement lying = placement; // the rod's axis along the cloth's x
        lying.y_axis = placement.x_axis;
        lying.x_axis = -placement.y_axis;
        lying.origin = placement.origin + Vec3{0, 0.015f, 0};
        rods.add(rod, lying);
    };
    // Long banners over the front of the gallery, short ones in the gallery's arches.
    const int colors[kBayCount] = {0, 1, 2, 0, 1, 2, 0, 1};
    for (float side : {-1.0f, 1.0f})
    {
        const float facing = side > 0 ? -0.5f * kPi : 0.5f * kPi;
        for (int bay = 0; bay < kBayCount; ++bay)
        {
            const float z = columnZ(bay) + 1.5f;
            const float phase = 0.37f * float(bay) + (side > 0 ? 0.0f : 0.19f);
            if (bay % 2 == (side > 0 ? 0 : 1))
                hang(colors[bay], 1.35f, 2.75f, turned(facing, {side * (kArcade - 0.33f), kGallery + 0.86f, z}), phase);
        }
    }
    gltf.add("banner rods", rods, m.bronze);
}

void addLanterns(GltfWriter& gltf, const AtriumMaterials& m)
{
    const float vault = kSpring + 1.2f;
    const Vec3 places[2] = {{-4.6f, 2.75f, 1.5f}, {4.6f, 2.75f, -7.5f}};
    Mesh frames, lamps;
    for (const Vec3& place : places)
    {
        frames.add(lanternFrame(vault - place.y - 0.34f), at(place.x, place.y, place.z));
        lamps.add(sphere(0.10f, 16, 10), at(place.x, place.y, place.z));
    }
    gltf.add("lanterns", frames, m.bronze);
    gltf.add("lamps", lamps, m.lamp);
}

void addMirror(GltfWriter& gltf, const AtriumMaterials& m)
{
    const float width = 2.5f, height = 3.1f, z = -kHalfLength;
    Mesh border, glass;
    border.add(frame(width, height, 0.16f, 0.14f), at(0, 0.55f, z + 0.09f));
    addQuad(glass, {-0.5f * width, 0.55f, z + 0.07f}, {width, 0, 0}, {0, height, 0});
    gltf.add("mirror frame", border, m.gold);
    gltf.add("mirror", glass, m.mirror);

    // Above it three blind arches, and pilasters beside it.
    Mesh stone;
    const Mesh moulding = archMoulding({{0.72f, -0.05f}, {0.72f, 0.05f}, {0.86f, 0.05f}, {0.90f, -0.05f}}, 20);
    for (int i = -1; i <= 1; ++i)
        stone.add(moulding, at(1.9f * float(i), 7.0f, z));
    for (int i = 0; i < 4; ++i)
    {
        const float x = 1.9f * (float(i) - 1.5f);
        stone.add(box({x - 0.11f, 4.8f, z - 0.05f}, {x + 0.11f, 6.9f, z + 0.07f}, 0.01f));
        stone.add(box({x - 0.17f, 6.86f, z - 0.05f}, {x + 0.17f, 7.02f, z + 0.10f}, 0.01f));
    }
    for (float end : {-1.0f, 1.0f}) // string course and cornice go on round the ends
    {
        const float wall = end * kHalfLength;
        for (const auto& [y0, y1, out] : {std::tuple{4.42f, 4.52f, 0.06f},
                                          {4.52f, 4.68f, 0.12f},
                                          {4.68f, 4.79f, 0.19f},
                                          {9.55f, 9.75f, 0.12f},
                                          {9.75f, 10.05f, 0.2f}})
        {
            const float a = wall + 0.05f * end, b = wall - out * end;
            stone.add(box({-kArcade - 0.01f, y0 - 0.003f, std::min(a, b)},
                          {kArcade + 0.01f, y1 - 0.003f, std::max(a, b)}, 0.015f));
        }
    }
    gltf.add("end walls' stonework", stone, m.limestone);
}

void addFurniture(GltfWriter& gltf, const AtriumMaterials& m)
{
    constexpr float kHair = 1e-3f; // things stand this far above what carries them
    Mesh stone, gold, ball, cup, water;
    const auto stand = [&](float x, float z, float height) { stone.add(pedestal(height), at(x, -0.005f, z)); };
    stand(-1.85f, 3.9f, 1.0f);
    gold.add(urn(), at(-1.85f, 0.995f + kHair, 3.9f));
    stand(1.95f, 4.9f, 0.95f);
    cup.add(goblet(), at(1.95f, 0.945f + kHair, 4.9f));
    stand(-0.75f, -9.4f, 0.9f);
    ball.add(sphere(0.28f, 80, 40), at(-0.75f, 0.895f + kHair + 0.28f, -9.4f));
    stand(0.85f, -9.9f, 0.75f);
    gold.add(sphere(0.22f, 56, 28), at(0.85f, 0.745f + kHair + 0.22f, -9.9f));
    gltf.add("pedestals", stone, m.marble);
    gltf.add("gold", gold, m.gold);
    gltf.add("glass sphere", ball, m.glass);
    gltf.add("glass goblet", cup, m.glass);

    Mesh rim;
    rim.add(basin(1.15f), at(-0.5f, -0.002f, -1.5f));
    gltf.add("basin", rim, m.limestone);
    water.add(lathe({{1.10f, 0.40f}, {0, 0.40f}}, 48), at(-0.5f, 0, -1.5f));
    gltf.add("water", water, m.water);

    // A glazed screen in one bay of the left-hand arcade.
    Mesh bars, pane;
    const Placement place = turned(0.5f * kPi, {-kArcade - 0.25f, 0.10f, 4.5f});
    bars.add(frame(2.1f, 2.3f, 0.09f, 0.09f), place);
    bars.add(box({-0.03f, 0.001f, -0.03f}, {0.03f, 2.299f, 0.03f}), place);
    bars.add(box({-1.049f, 1.45f, -0.029f}, {1.049f, 1.51f, 0.029f}), place);
    Mesh sheet_of_glass;
    addQuad(sheet_of_glass, {-1.06f, -0.01f, 0}, {2.12f, 0, 0}, {0, 2.32f, 0});
    pane.add(sheet_of_glass, place);
    gltf.add("screen frame", bars, m.bronze);
    gltf.add("screen pane", pane, m.pane);
}

} // namespace

GltfWriter atriumScene()
{
    GltfWriter gltf;
    const AtriumMaterials m = addAtriumMaterials(gltf);
    addShell(gltf, m);
    addRoof(gltf, m);
    for (float turn : {0.0f, kPi})
    {
        addArcades(gltf, m, turn);
        addGallery(gltf, m, turn);
    }
    addColumns(gltf, m);
    addBanners(gltf, m);
    addLanterns(gltf, m);
    addMirror(gltf, m);
    addFurniture(gltf, m);
    gltf.addCamera("hall", {-0.5f, 1.65f, 9.4f}, {0.12f, 3.05f, -4.0f}, 0.96f);
    gltf.addCamera("gallery", {-2.85f, 6.45f, 7.7f}, {1.7f, 1.3f, -2.2f}, 1.0f);
    gltf.addCamera("glass", {0.35f, 1.45f, -7.2f}, {-0.25f, 1.35f, -12.0f}, 0.80f);
    return gltf;
}
