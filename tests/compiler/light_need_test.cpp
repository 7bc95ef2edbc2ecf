#include "compiler/light_need.h"
#include "tests/compiler/gltf_builder.h"

#include <gtest/gtest.h>

#include <numbers>

namespace
{
constexpr double kPi = std::numbers::pi;

/// A floor of `side`, seen from 1.5 sides above by a camera that points down, with whatever else a test adds.
struct Room : GltfBuilder
{
    explicit Room(float side) : side_(side)
    {
        material({{"name", "floor"}});
        addQuad(0, 0, side);
        json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"znear", 0.01}}}}};
        node({{"camera", 0},
              {"translation", {0, 1.5 * side, 0}},
              {"rotation", {-0.7071067811865476, 0, 0, 0.7071067811865476}}});
    }

    /// A square that faces down where it emits, else up.
    void addQuad(int material_index, float height, float side, float x = 0, bool down = false)
    {
        const float h = side / 2;
        const int p = positions({x - h, height, h, x + h, height, h, x + h, height, -h, x - h, height, -h});
        const int indices =
            accessor(down ? std::vector<uint16_t>{0, 2, 1, 0, 3, 2} : std::vector<uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR",
                     5123, 6);
        node({{"mesh", mesh({{"attributes", {{"POSITION", p}}}, {"indices", indices}, {"material", material_index}})}});
    }
    int glowing(float radiance)
    {
        return material({{"name", "glow"}, {"emissiveFactor", {radiance, radiance, radiance}}});
    }
    void addPoint(float intensity, float height)
    {
        json["extensionsUsed"] = {"KHR_lights_punctual"};
        json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", intensity}}};
        node({{"translation", {0, height, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    }

    LightNeed need()
    {
        json["scenes"][0]["nodes"] = nlohmann::json::array();
        for (size_t i = 0; i < json["nodes"].size(); ++i)
            json["scenes"][0]["nodes"].push_back(i);
        const Result<SceneData> scene = this->scene();
        EXPECT_TRUE(scene) << scene.error().message;
        const std::vector<uint32_t> flags(scene->mesh.triangles.size());
        return judgeLight(*scene, buildBvh(scene->mesh, flags), buildLights(*scene));
    }

    float side_;
};

TEST(LightNeed, WithoutLightItIsDarkAndSaysSo)
{
    const LightNeed need = Room(2).need();
    EXPECT_TRUE(need.dark);
    EXPECT_EQ(need.radiance, 0);
    EXPECT_NE(need.sentence.find("no light at all"), std::string::npos);
}

TEST(LightNeed, OfAPointLightIsItsClosedForm)
{
    // Far above a floor irradiance is I / d^2 everywhere on it, and once more I / D^2 with the diagonal D for what is
    // spread; a white surface reflects a pi-th of the sum. Distances vary by side^2 / d^2 = 1 %.
    Room room(1);
    room.addPoint(20, 10);
    EXPECT_NEAR(room.need().radiance, (20 / 100.0 + 20 / 102.0) / kPi, 0.02 * 0.4 / kPi);
}

TEST(LightNeed, DoesNotDependOnTheScenesSize)
{
    const auto radiance = [](float scale)
    {
        Room room(2 * scale);
        room.addQuad(room.glowing(1), 1.2f * scale, 0.2f * scale, 0.3f * scale, true);
        return room.need().radiance;
    };
    const double metres = radiance(1);
    EXPECT_GT(metres, 0);
    EXPECT_NEAR(radiance(100), metres, 1e-4 * metres);
    EXPECT_NEAR(radiance(0.1f), metres, 1e-4 * metres);
}

TEST(LightNeed, ATinyEmitterLeavesItDarkAndIsNamed)
{
    Room room(2);
    room.addQuad(room.glowing(1), 0.3f, 0.004f, 0, true);
    const LightNeed need = room.need();
    EXPECT_TRUE(need.dark) << need.radiance;
    EXPECT_NE(need.sentence.find("\"glow\""), std::string::npos) << need.sentence;
}

TEST(LightNeed, ASurfaceThatGlowsByNoiseLeavesItDark)
{
    Room room(2);
    room.addQuad(room.glowing(0.0006f), 0.4f, 0.8f); // 2 of 255, and half of the view
    EXPECT_TRUE(room.need().dark);
}

TEST(LightNeed, AGlowThatLeavesTheSceneDoesNotLightIt)
{
    Room label(2), lamp(2); // the same panel, a sixteenth of the floor, shining away from it and onto it
    label.addQuad(label.glowing(1), 0.01f, 0.5f);
    lamp.addQuad(lamp.glowing(1), 1, 0.5f, 0, true);
    EXPECT_TRUE(label.need().dark) << label.need().radiance;
    EXPECT_FALSE(lamp.need().dim) << lamp.need().radiance;
}

TEST(LightNeed, OneHonestLampInADimRoomIsEnough)
{
    Room lamp(3);
    lamp.addQuad(lamp.glowing(1), 1.5f, 0.2f, 0, true); // 0.13 W
    EXPECT_FALSE(lamp.need().dark);
    EXPECT_TRUE(lamp.need().dim); // with a message
    Room candle(10);
    candle.addPoint(1, 3);
    EXPECT_FALSE(candle.need().dark);
}

TEST(LightNeed, ANarrowBeamIsItsAuthorsLightWhereverItGoes)
{
    Room room(3);
    room.addPoint(5, 2);
    nlohmann::json& light = room.json["extensions"]["KHR_lights_punctual"]["lights"][0];
    light["type"] = "spot";
    light["spot"] = {{"innerConeAngle", 0.001}, {"outerConeAngle", 0.01}};
    EXPECT_FALSE(room.need().dark); // its node's -z is horizontal: it does not even meet the floor
}

TEST(LightNeed, ManySmallLightsAreAsOneThatIsAsLarge)
{
    // 18 x 18 tiles are 648 triangles, of which 256 are sampled: each represents two or three neighbours of a ceiling that
    // is as far away as it is wide, so that distances within such a group differ by 1 / 18 and the mean by its square.
    Room tiles(2);
    const int glow = tiles.glowing(1);
    std::vector<float> positions;
    std::vector<uint16_t> indices;
    for (int i = 0; i < 18 * 18; ++i)
    {
        const float x = float(i % 18) / 9 - 1, z = float(i / 18) / 9 - 1, step = 1.0f / 9;
        const auto first = uint16_t(positions.size() / 3);
        positions.insert(positions.end(), {x, 2, z, x + step, 2, z, x + step, 2, z + step, x, 2, z + step});
        for (const int corner : {0, 1, 2, 0, 2, 3})
            indices.push_back(uint16_t(first + corner));
    }
    const int p = tiles.positions(positions);
    const int count = int(indices.size());
    const int list = tiles.accessor(indices, "SCALAR", 5123, size_t(count));
    tiles.node({{"mesh", tiles.mesh({{"attributes", {{"POSITION", p}}}, {"indices", list}, {"material", glow}})}});
    tiles.json["nodes"][1]["translation"] = {0, 1.9, 0}; // the camera, below the ceiling
    // A square of side a at distance a above the floor's middle: its form factor there is 0.2394 (four quarters, each a
    // rectangle over its corner with both ratios 1/2: 0.05986), a quarter of the floor about there has no less than 0.91 of it.
    // Of what leaves the ceiling the floor meets 0.1998 (equal squares opposite each other).
    const double spread = 0.1998 * kPi * 4 / (4 * kPi * 12);
    const double most = 0.2394 + spread / kPi;
    EXPECT_LT(tiles.need().radiance, 1.01 * most);
    EXPECT_GT(tiles.need().radiance, 0.9 * most);
}

TEST(LightNeed, WhereCamerasSeeNothingTheWholeSceneCounts)
{
    Room room(2);
    room.addPoint(5, 1);
    room.json["nodes"][1].erase("rotation");
    room.json["nodes"][1]["translation"] = {0, 1, -50}; // points away
    EXPECT_FALSE(room.need().dark);
}
} // namespace
