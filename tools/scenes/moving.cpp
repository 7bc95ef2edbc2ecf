// Scenes in which something moves.
#include "tools/scenes/rooms.h"
#include "tools/scenes/scenes.h"

#include <numbers>

namespace
{
constexpr float kPi = std::numbers::pi_v<float>;

/// x y z w of a turn.
std::array<float, 4> turn(Vec3 axis, float radians)
{
    const Vec3 a = normalize(axis) * std::sin(radians / 2);
    return {a.x, a.y, a.z, std::cos(radians / 2)};
}

/// Keys of a function of time, `count` of them and one more, evenly from 0 to `seconds`.
template <typename Value>
struct Keys
{
    std::vector<float> times, values;

    template <typename At>
    Keys(float seconds, int count, const At& at)
    {
        for (int i = 0; i <= count; ++i)
        {
            times.push_back(seconds * float(i) / float(count));
            const Value value = at(times.back());
            const float* const first = reinterpret_cast<const float*>(&value);
            values.insert(values.end(), first, first + sizeof(Value) / sizeof(float));
        }
    }
};
using Places = Keys<Vec3>;
using Turns = Keys<std::array<float, 4>>;

MaterialDescription smooth(const char* name, Vec3 color, float metallic, float transmission, float thickness)
{
    MaterialDescription material;
    material.name = name;
    material.base_color = color;
    material.metallic = metallic;
    material.roughness = 0;
    material.transmission = transmission;
    material.thickness = thickness;
    return material;
}
} // namespace

GltfWriter doorScene()
{
    GltfWriter gltf;
    const uint32_t white = gltf.addMaterial(matte("plaster", {0.72f, 0.70f, 0.66f}));
    const uint32_t red = gltf.addMaterial(matte("red plaster", {0.60f, 0.20f, 0.15f}));
    const uint32_t wood = gltf.addMaterial(matte("wood", {0.45f, 0.28f, 0.14f}));
    const uint32_t light = gltf.addMaterial(glow("lamp", {60, 55, 48}));
    // The dark room lies at x < 0, the hall at x > 0; between them a wall with a doorway of 0.9 x 2 m.
    gltf.add("room", innerFaces({-3, 0, -2}, {0, 2.6f, 2}, false), white);
    Mesh hall;
    addQuad(hall, {0, 0, -2}, {0, 0, 4}, {3, 0, 0});
    addQuad(hall, {3, 2.6f, 2}, {-3, 0, 0}, {0, 0, -4});
    addQuad(hall, {0, 0, -2}, {3, 0, 0}, {0, 2.6f, 0});
    addQuad(hall, {3, 2.6f, 2}, {0, -2.6f, 0}, {-3, 0, 0});
    gltf.add("hall", hall, white);
    Mesh end;
    addQuad(end, {3, 0, 2}, {0, 0, -4}, {0, 2.6f, 0});
    gltf.add("end of the hall", end, red);
    Mesh wall;
    addQuad(wall, {0, 0, -2}, {0, 0, 1.55f}, {0, 2.6f, 0});
    addQuad(wall, {0, 0, 0.45f}, {0, 0, 1.55f}, {0, 2.6f, 0});
    addQuad(wall, {0, 2, -0.45f}, {0, 0, 0.9f}, {0, 0.6f, 0});
    gltf.add("wall", wall, white);
    Mesh lamp;
    addQuad(lamp, {1.2f, 2.55f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f});
    gltf.add("lamp", lamp, light);
    Mesh block;
    block.add(box({-0.3f, 1e-3f, -0.3f}, {0.3f, 0.8f, 0.3f}, 0.01f), at(-1.9f, 0, -0.9f));
    gltf.add("block", block, white);
    // Hinged at z = -0.45, it closes the doorway but for a gap of 4 mm.
    const uint32_t leaf = gltf.addMesh("door", box({-0.02f, 4e-3f, 4e-3f}, {0.02f, 1.996f, 0.896f}, 2e-3f), wood);
    const uint32_t door = gltf.addNode("door", leaf, {0, 0, -0.45f});
    const Turns opens(2, 32,
                      [](float t) {
                          return turn({0, 1, 0}, 0.5f * kPi * (0.5f - 0.5f * std::cos(kPi * t / 2)));
                      });
    gltf.animate(door, "rotation", opens.times, opens.values);
    gltf.addCamera("room", {-2.7f, 1.5f, 1.5f}, {-0.3f, 1.0f, -0.3f}, 1.1f);
    return gltf;
}

GltfWriter lampScene()
{
    GltfWriter gltf;
    const uint32_t white = gltf.addMaterial(matte("plaster", {0.7f, 0.7f, 0.7f}));
    const uint32_t blue = gltf.addMaterial(matte("blue", {0.2f, 0.3f, 0.6f}));
    const uint32_t light = gltf.addMaterial(glow("lamp", {300, 260, 200}));
    gltf.add("room", innerFaces({-2, 0, -2}, {2, 2.4f, 2}), white);
    Mesh posts;
    for (const Vec3 place : {Vec3{-0.7f, 0, -0.7f}, Vec3{0.8f, 0, -0.5f}, Vec3{0, 0, 0.5f}})
        posts.add(box({-0.12f, 1e-3f, -0.12f}, {0.12f, 1.3f, 0.12f}, 0.01f), at(place.x, place.y, place.z));
    gltf.add("posts", posts, blue);
    // The point light is above the ball, which would hide it.
    gltf.add("bulb", sphere(0.04f, 32, 16), light);
    gltf.addPoint("spark", {0, 0.08f, 0}, {1.0f, 0.85f, 0.6f}, 4);
    const auto path = [](float t) -> Vec3 {
        return {1.3f * std::cos(kPi * t / 2), 1.5f + 0.2f * std::sin(kPi * t), 1.3f * std::sin(kPi * t / 2)};
    };
    const uint32_t carrier = gltf.group("carrier", 2, path(0));
    const Places places(4, 64, path);
    gltf.animate(carrier, "translation", places.times, places.values);
    gltf.addCamera("corner", {-1.8f, 2.0f, 1.8f}, {0.1f, 0.7f, 0}, 1.1f);
    return gltf;
}

namespace
{
/// A bar of round ends along -y from `top`, whose vertices follow one joint, and near the top the one above as well.
struct Limb
{
    Vec3 top;
    float length, radius;
    uint16_t joint, above;
};

struct Figure
{
    Mesh mesh;
    std::vector<std::array<float, 4>> weights;
    std::vector<std::array<uint16_t, 4>> joints;

    void add(const Limb& limb)
    {
        const size_t first = mesh.positions.size();
        std::vector<Vec2> profile;
        constexpr int kRound = 6, kAlong = 8;
        for (int i = 0; i <= kRound; ++i)
        {
            const float a = 0.5f * kPi * float(i) / kRound;
            profile.push_back({limb.radius * std::sin(a), -limb.length - limb.radius * std::cos(a)});
        }
        for (int i = 1; i < kAlong; ++i)
            profile.push_back({limb.radius, -limb.length * (1 - float(i) / kAlong)});
        for (int i = 0; i <= kRound; ++i)
        {
            const float a = 0.5f * kPi * float(i) / kRound;
            profile.push_back({limb.radius * std::cos(a), limb.radius * std::sin(a)});
        }
        mesh.add(lathe(profile, 20), at(limb.top.x, limb.top.y, limb.top.z));
        for (size_t v = first; v < mesh.positions.size(); ++v)
        {
            // Half from each joint at the top, the limb's alone a radius below.
            const float below = (limb.top.y - mesh.positions[v].y) / limb.radius;
            const float own = limb.joint == limb.above ? 1 : std::min(1.0f, std::max(0.0f, 0.5f + 0.5f * below));
            weights.push_back({own, 1 - own, 0, 0});
            joints.push_back({limb.joint, limb.above, 0, 0});
        }
    }
};
} // namespace

GltfWriter walkerScene()
{
    GltfWriter gltf;
    const uint32_t white = gltf.addMaterial(matte("plaster", {0.7f, 0.7f, 0.68f}));
    const uint32_t light = gltf.addMaterial(glow("lamp", {30, 29, 27}));
    const uint32_t cloth = gltf.addMaterial(matte("cloth", {0.55f, 0.25f, 0.12f}));
    gltf.add("room", innerFaces({-3, 0, -1.5f}, {3, 3, 1.5f}), white);
    Mesh lamp;
    addQuad(lamp, {-0.8f, 2.98f, -0.5f}, {1.6f, 0, 0}, {0, 0, 1});
    gltf.add("lamp", lamp, light);
    // Hips, chest, two arms and two legs of two parts each; it looks along +x.
    enum : uint16_t
    {
        kHips,
        kChest,
        kHead,
        kLeftArm,
        kLeftHand,
        kRightArm,
        kRightHand,
        kLeftLeg,
        kLeftFoot,
        kRightLeg,
        kRightFoot
    };
    const std::vector<GltfWriter::Joint> joints{{"hips", -1, {0, 0.92f, 0}},
                                                {"chest", kHips, {0, 0.25f, 0}},
                                                {"head", kChest, {0, 0.40f, 0}},
                                                {"left arm", kChest, {0, 0.22f, 0.24f}},
                                                {"left hand", kLeftArm, {0, -0.30f, 0}},
                                                {"right arm", kChest, {0, 0.22f, -0.24f}},
                                                {"right hand", kRightArm, {0, -0.30f, 0}},
                                                {"left leg", kHips, {0, -0.06f, 0.11f}},
                                                {"left foot", kLeftLeg, {0, -0.40f, 0}},
                                                {"right leg", kHips, {0, -0.06f, -0.11f}},
                                                {"right foot", kRightLeg, {0, -0.40f, 0}}};
    Figure figure;
    figure.add({{0, 1.37f, 0}, 0.20f, 0.17f, kChest, kChest});
    figure.add({{0, 1.08f, 0}, 0.14f, 0.15f, kHips, kChest});
    figure.add({{0, 1.72f, 0}, 0.06f, 0.11f, kHead, kHead});
    for (const float side : {1.0f, -1.0f})
    {
        const bool left = side > 0;
        figure.add({{0, 1.39f, 0.24f * side}, 0.30f, 0.055f, left ? kLeftArm : kRightArm, left ? kLeftArm : kRightArm});
        figure.add(
            {{0, 1.09f, 0.24f * side}, 0.26f, 0.05f, left ? kLeftHand : kRightHand, left ? kLeftArm : kRightArm});
        figure.add({{0, 0.86f, 0.11f * side}, 0.40f, 0.08f, left ? kLeftLeg : kRightLeg, kHips});
        figure.add(
            {{0, 0.46f, 0.11f * side}, 0.385f, 0.07f, left ? kLeftFoot : kRightFoot, left ? kLeftLeg : kRightLeg});
    }
    const std::vector<uint32_t> nodes =
        gltf.addSkinned("figure", figure.mesh, cloth, joints, figure.weights, figure.joints);
    // Two steps a second, 4 m in 4 s.
    const Places walks(4, 64,
                       [](float t) -> Vec3 {
                           return {-2 + t, 0.92f - 0.02f + 0.02f * std::cos(4 * kPi * t), 0};
                       });
    gltf.animate(nodes[kHips], "translation", walks.times, walks.values);
    const auto swing = [&](uint16_t joint, float phase, float middle, float range)
    {
        const Turns turns(4, 64,
                          [&](float t) {
                              return turn({0, 0, 1}, middle + range * std::sin(2 * kPi * t + phase));
                          });
        gltf.animate(nodes[joint], "rotation", turns.times, turns.values);
    };
    swing(kLeftLeg, 0, 0.05f, 0.5f);
    swing(kRightLeg, kPi, 0.05f, 0.5f);
    swing(kLeftFoot, -0.5f * kPi, -0.45f, 0.4f);
    swing(kRightFoot, 0.5f * kPi, -0.45f, 0.4f);
    swing(kLeftArm, kPi, 0, 0.45f);
    swing(kRightArm, 0, 0, 0.45f);
    swing(kLeftHand, kPi, 0.4f, 0.2f);
    swing(kRightHand, 0, 0.4f, 0.2f);
    gltf.addCamera("side", {0.6f, 1.5f, 1.45f}, {-0.2f, 0.95f, -0.3f}, 1.3f);
    return gltf;
}

GltfWriter ballScene()
{
    GltfWriter gltf;
    const uint32_t white = gltf.addMaterial(matte("plaster", {0.65f, 0.65f, 0.65f}));
    const uint32_t clear = gltf.addMaterial(smooth("glass", {1, 1, 1}, 0, 1, 0.3f));
    const uint32_t mirror = gltf.addMaterial(smooth("silver", {0.95f, 0.93f, 0.90f}, 1, 0, 0));
    const uint32_t light = gltf.addMaterial(glow("lamp", {1200, 1100, 950}));
    gltf.add("room", innerFaces({-1, 0, -1}, {1, 1.5f, 1}), white);
    Mesh glass;
    glass.add(sphere(0.15f, 128, 64), at(-0.1f, 0.35f, 0));
    gltf.add("glass ball", glass, clear);
    Mesh lamp;
    addQuad(lamp, {-0.52f, 1.45f, -0.02f}, {0.04f, 0, 0}, {0, 0, 0.04f});
    gltf.add("lamp", lamp, light);
    constexpr float kRadius = 0.08f, kHair = 5e-4f, kFrom = -0.7f, kSpeed = 0.35f;
    const uint32_t ball = gltf.addNode("mirror ball", gltf.addMesh("mirror ball", sphere(kRadius, 96, 48), mirror),
                                       {0.05f, kRadius + kHair, kFrom});
    const Places rolls(4, 1, [&](float t) -> Vec3 { return {0.05f, kRadius + kHair, kFrom + kSpeed * t}; });
    gltf.animate(ball, "translation", rolls.times, rolls.values);
    const Turns turns(4, 64, [&](float t) { return turn({1, 0, 0}, kSpeed * t / kRadius); });
    gltf.animate(ball, "rotation", turns.times, turns.values);
    gltf.addCamera("front", {0.8f, 0.7f, 0.9f}, {0, 0.15f, 0}, 0.9f);
    return gltf;
}
